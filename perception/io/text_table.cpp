#include "perception/io/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/io/text_file.hpp"

namespace understory {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";
constexpr std::size_t maximum_cells = 16'000'000;  // of 16 bytes each
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

bool is_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::vector<TableLine> table_lines(std::string_view text, CellsParted parted, const std::string& name) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  std::vector<TableLine> lines;
  std::size_t cells = 0;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks(text.substr(0, end));
    if (!line.empty() && line.front() != '#') {
      lines.push_back({number, cells_of(line, parted)});
      cells += lines.back().cells.size();
      if (cells > maximum_cells) fail_at_line(name, number, "a table must have at most 16 million cells");
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::optional<std::int64_t> nanoseconds_in(std::string_view cell) {
  const auto value = number_in<std::int64_t>(cell);
  return value && *value >= 0 ? value : std::nullopt;
}

std::optional<std::int64_t> seconds_in(std::string_view cell) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  constexpr std::int64_t maximum_s = std::numeric_limits<std::int64_t>::max() / ns_per_s - 1;
  const std::size_t point = std::min(cell.find('.'), cell.size());
  const std::string_view whole = cell.substr(0, point);
  const std::string_view fraction = cell.substr(std::min(point + 1, cell.size()));
  if (!whole.empty() && is_digits(whole) && is_digits(fraction)) {
    const auto seconds = number_in<std::int64_t>(whole);
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

void fail_at_line(const std::string& name, int line, const std::string& expected) {
  refuse_input(place_in(name, line), "", expected);
}

}  // namespace understory
