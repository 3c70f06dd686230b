#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/output/file_output.hpp"

namespace understory {

/// An MCAP file (mcap.dev/spec) of messages in order of time: chunks in zstd with checksums and indexes, a
/// summary at its end. It is an OutputFile.
class McapFile {
 public:
  /// Throws ScenarioError where the file cannot be made.
  McapFile(const std::filesystem::path& file, FolderMark* mark);

  /// A topic of protobuf messages of the type `schema` ("foxglove.Log"), which `descriptors`, a serialised
  /// google.protobuf.FileDescriptorSet, describes. Gives the channel's number.
  std::uint16_t add_channel(std::string_view topic, std::string_view schema, const std::string& descriptors);

  /// Throws MachineError where the disk is full.
  void add(std::uint16_t channel, std::int64_t t_ns, std::string_view message);
  void finish();

 private:
  struct Chunk {
    std::uint64_t from_ns = 0, to_ns = 0;
    std::string records;
    std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index;  ///< time, offset
  };
  void write(std::string_view bytes);
  void end_chunk();
  std::string statistics() const;

  OutputFile file_;
  std::uint64_t position_ = 0;
  Chunk chunk_;
  std::map<std::string, std::uint16_t, std::less<>> schemas_;
  std::string schema_records_, channel_records_, chunk_index_records_;
  std::vector<std::uint64_t> message_counts_;  ///< by channel, from channel 1 on
  std::uint32_t chunks_ = 0;
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
};

}  // namespace understory
