#include "perception/io/text_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace understory {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line, CellsParted parted) {
  const std::string_view ends = parted == CellsParted::by_commas ? std::string_view(",") : blanks;
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = line.find_first_of(ends);
    cells.push_back(without_blanks(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
    if (parted == CellsParted::by_blanks) line = without_blanks(line);
  }
}

/// The whole of `text` as a number of type T.
template <typename T>
std::optional<T> whole_cell(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::vector<TableLine> table_lines(std::string_view text, CellsParted parted) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  std::vector<TableLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks(text.substr(0, end));
    if (!line.empty() && line.front() != '#') lines.push_back({number, cells_of(line, parted)});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::optional<double> number_in(std::string_view cell) {
  const auto value = whole_cell<double>(cell);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> nanoseconds_in(std::string_view cell) {
  const auto value = whole_cell<std::int64_t>(cell);
  return value && *value >= 0 ? value : std::nullopt;
}

std::optional<std::int64_t> seconds_in(std::string_view cell) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  constexpr std::int64_t maximum_s = std::numeric_limits<std::int64_t>::max() / ns_per_s - 1;
  const std::size_t point = std::min(cell.find('.'), cell.size());
  const std::string_view whole = cell.substr(0, point);
  const std::string_view fraction = cell.substr(std::min(point + 1, cell.size()));
  if (!whole.empty() && is_digits(whole) && is_digits(fraction)) {
    const auto seconds = whole_cell<std::int64_t>(whole);
    if (!seconds || *seconds > maximum_s) return std::nullopt;
    std::int64_t nanoseconds = 0;
    for (std::size_t i = 0; i < 9; ++i)
      nanoseconds = 10 * nanoseconds + (i < fraction.size() ? fraction[i] - '0' : 0);
    if (fraction.size() > 9 && fraction[9] >= '5') ++nanoseconds;
    return *seconds * ns_per_s + nanoseconds;
  }
  const auto seconds = number_in(cell);
  if (!seconds || !(*seconds >= 0 && *seconds <= static_cast<double>(maximum_s))) return std::nullopt;
  return std::llround(*seconds * static_cast<double>(ns_per_s));
}

std::string text_of(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(file, ignored).type();
  const bool is_endless = kind == std::filesystem::file_type::character;  // a device
  std::ifstream stream(file, std::ios::binary);
  if (!stream || kind == std::filesystem::file_type::directory || is_endless)
    throw std::runtime_error(file.string() + ": expected a readable file");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void fail_at_line(const std::string& name, int line, const std::string& expected) {
  throw std::runtime_error(name + ":" + std::to_string(line) + ": " + expected);
}

}  // namespace understory
