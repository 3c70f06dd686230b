#include "scenarios/recording/mcap_file.hpp"

#include <zstd.h>

#include <bit>
#include <boost/crc.hpp>
#include <numeric>

#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"

namespace understory {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view magic = "\x89MCAP0\r\n";
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

enum Record : std::uint8_t {
  header_record = 0x01,
  footer_record = 0x02,
  schema_record = 0x03,
  channel_record = 0x04,
  message_record = 0x05,
  chunk_record = 0x06,
  message_index_record = 0x07,
  chunk_index_record = 0x08,
  statistics_record = 0x0B,
  summary_offset_record = 0x0E,
  data_end_record = 0x0F
};

template <typename T>
std::string number(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Its length in four bytes, then the text; a map or a list of numbers is written so, too.
std::string sized(std::string_view text) {
  return number(static_cast<std::uint32_t>(text.size())).append(text);
}

std::string record(Record kind, std::string_view content) {
  return number(static_cast<std::uint8_t>(kind))
      .append(number(std::uint64_t{content.size()}))
      .append(content);
}

std::uint32_t crc_of(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string compressed(const std::string& bytes) {
  std::string result(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), 3);
  if (ZSTD_isError(size)) throw MachineError(std::string("zstd: ") + ZSTD_getErrorName(size));
  result.resize(size);
  return result;
}

}  // namespace

McapFile::McapFile(const std::filesystem::path& file, FolderMark* mark) : file_(file, mark) {
  write(magic);
  write(record(header_record, sized("").append(sized(std::string("understory ") + understory_version))));
}

void McapFile::write(std::string_view bytes) {
  file_.write(bytes);
  position_ += bytes.size();
}

std::uint16_t McapFile::add_channel(std::string_view topic, std::string_view schema,
                                    const std::string& descriptors) {
  auto known = schemas_.find(schema);
  if (known == schemas_.end()) {
    known = schemas_.emplace(schema, static_cast<std::uint16_t>(schemas_.size() + 1)).first;
    schema_records_ +=
        record(schema_record, number(known->second) + sized(schema) + sized("protobuf") + sized(descriptors));
  }
  message_counts_.push_back(0);
  const auto channel = static_cast<std::uint16_t>(message_counts_.size());
  channel_records_ += record(
      channel_record, number(channel) + number(known->second) + sized(topic) + sized("protobuf") + sized(""));
  return channel;
}

void McapFile::add(std::uint16_t channel, std::int64_t t_ns, std::string_view message) {
  const auto time_ns = static_cast<std::uint64_t>(t_ns);
  // Each chunk repeats schemas and channels, for readers that stream, or that have only a part of the file.
  if (chunk_.records.empty()) {
    chunk_.records = schema_records_ + channel_records_;
    chunk_.from_ns = time_ns;
  }
  std::uint64_t& count = message_counts_[channel - 1u];
  if (std::accumulate(message_counts_.begin(), message_counts_.end(), std::uint64_t{0}) == 0)
    first_ns_ = time_ns;
  chunk_.index[channel].emplace_back(time_ns, chunk_.records.size());
  chunk_.from_ns = std::min(chunk_.from_ns, time_ns);
  chunk_.to_ns = std::max(chunk_.to_ns, time_ns);
  first_ns_ = std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);
  chunk_.records += record(message_record, (number(channel) + number(static_cast<std::uint32_t>(count)) +
                                            number(time_ns) + number(time_ns))
                                               .append(message));
  ++count;
  if (chunk_.records.size() > chunk_bytes) end_chunk();
}

void McapFile::end_chunk() {
  if (chunk_.records.empty()) return;
  const std::string bytes = compressed(chunk_.records);
  const std::uint64_t size = chunk_.records.size(), start = position_;
  write(record(chunk_record,
               (number(chunk_.from_ns) + number(chunk_.to_ns) + number(size) +
                number(crc_of(chunk_.records)) + sized("zstd") + number(std::uint64_t{bytes.size()}))
                   .append(bytes)));
  const std::uint64_t length = position_ - start, indexes = position_;
  std::string offsets;
  for (const auto& [channel, entries] : chunk_.index) {
    offsets += number(channel) + number(position_);
    std::string times;
    for (const auto& [time_ns, offset] : entries) times += number(time_ns) + number(offset);
    write(record(message_index_record, number(channel) + sized(times)));
  }
  chunk_index_records_ +=
      record(chunk_index_record, number(chunk_.from_ns) + number(chunk_.to_ns) + number(start) +
                                     number(length) + sized(offsets) + number(position_ - indexes) +
                                     sized("zstd") + number(std::uint64_t{bytes.size()}) + number(size));
  ++chunks_;
  chunk_ = {};
}

std::string McapFile::statistics() const {
  std::string counts;
  std::uint64_t messages = 0;
  for (std::size_t i = 0; i < message_counts_.size(); ++i) {
    counts += number(static_cast<std::uint16_t>(i + 1)) + number(message_counts_[i]);
    messages += message_counts_[i];
  }
  constexpr std::uint32_t none = 0;  // attachments, metadata
  return record(statistics_record, number(messages) + number(static_cast<std::uint16_t>(schemas_.size())) +
                                       number(static_cast<std::uint32_t>(message_counts_.size())) +
                                       number(none) + number(none) + number(chunks_) + number(first_ns_) +
                                       number(last_ns_) + sized(counts));
}

void McapFile::finish() {
  end_chunk();
  write(record(data_end_record, number(std::uint32_t{0})));  // chunks bear their own checksums
  const std::uint64_t start = position_;
  std::string summary, offsets;
  for (const auto& [kind, records] : {std::pair(schema_record, schema_records_),
                                      {channel_record, channel_records_},
                                      {statistics_record, statistics()},
                                      {chunk_index_record, chunk_index_records_}}) {
    if (records.empty()) continue;
    offsets += record(summary_offset_record, number(static_cast<std::uint8_t>(kind)) +
                                                 number(start + summary.size()) +
                                                 number(std::uint64_t{records.size()}));
    summary += records;
  }
  const std::string places = number(start) + number(start + summary.size());
  summary += offsets;
  // The checksum reaches into the footer, up to itself.
  const std::string footer = record(footer_record, places + number(std::uint32_t{0}));
  summary += footer.substr(0, footer.size() - sizeof(std::uint32_t));
  write(summary);
  write(number(crc_of(summary)));
  write(magic);
  file_.finish();
}

}  // namespace understory
