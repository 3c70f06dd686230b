#include "perception/io/text_table.hpp"

#include <algorithm>
#include <cctype>
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

/// How long a text in quotation marks is that `text` begins with, marks included; 0 where the last one is
/// missing.
std::size_t quoted_length(std::string_view text) {
  std::size_t end = 0;
  do end = text.find('"', end + 1) + 1;
  while (end != 0 && end < text.size() && text[end] == '"');  // two of them stand for one
  return end;
}

/// Empty where a quotation mark is out of place.
std::vector<std::string_view> cells_of(std::string_view line, CellsParted parted) {
  const std::string_view ends = parted == CellsParted::by_commas ? std::string_view(",") : blanks;
  std::vector<std::string_view> cells;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::size_t quoted = line.starts_with('"') ? quoted_length(line) : 0;
    const std::size_t end = line.find_first_of(ends, quoted);
    const std::string_view cell = without_blanks(line.substr(0, end));
    if (cell.find('"') != std::string_view::npos && cell.size() != quoted) return {};
    cells.push_back(quoted > 0 ? cell.substr(1, quoted - 2) : cell);
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
    if (parted == CellsParted::by_blanks) line = without_blanks(line);
  }
}

/// Where the line that `text` begins with ends: no comment, and not within quotation marks.
std::size_t end_of_line(std::string_view text) {
  bool is_quoted = false;
  std::size_t end = 0;
  for (; end < text.size() && (is_quoted || text[end] != '\n'); ++end) is_quoted ^= text[end] == '"';
  return end;
}

/// A line of names in lower case, units joined to them in brackets: "t (ns), Q_x []" as "t[ns], q_x[]".
std::string as_names(std::string_view line) {
  std::string text;
  bool in_unit = false;
  for (char c : line) {
    const bool begins = c == '[' || c == '(', ends = c == ']' || c == ')';
    while (begins && !text.empty() && blanks.find(text.back()) != std::string_view::npos) text.pop_back();
    in_unit = (in_unit || begins) && !ends;
    if (!(in_unit && blanks.find(c) != std::string_view::npos))
      text += begins ? '[' : ends ? ']' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

std::vector<std::string> names_in(std::string_view line, CellsParted parted) {
  const std::string text = as_names(without_blanks(line));
  std::vector<std::string> names;
  for (const std::string_view cell : cells_of(text, parted))  // "t, x, y" above lines parted by blanks
    names.emplace_back(cell.substr(0, cell.find_last_not_of(',') + 1));
  return names;
}

bool is_among(std::string_view word, std::string words) {
  return !word.empty() && ('|' + words + '|').find('|' + std::string(word) + '|') != std::string::npos;
}

std::string_view unit_in(std::string_view name) {
  const std::size_t unit = name.find('[');
  return unit == std::string_view::npos ? "" : name.substr(unit + 1, name.find(']') - unit - 1);
}

/// Where the names have a column.
std::vector<std::size_t> places_of(const Column& column, const std::vector<std::string>& names) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (is_among(names[i].substr(0, names[i].find('[')), std::string(column.names))) places.push_back(i);
  return places;
}

/// Another unit or spelling of a column, which would be passed over: "height_cm" of "height_m".
bool is_nearly(std::string_view name, std::string_view column, std::span<const Column> columns) {
  return name.starts_with(column.substr(0, column.rfind('_'))) &&
         std::ranges::find(columns, name, &Column::names) == columns.end();
}

/// The names that a comment above the first line of values gives: all that are looked for, or one for each
/// cell.
std::vector<std::string> names_in_comment(std::string_view comment, const TableLine& first,
                                          CellsParted parted, std::span<const Column> columns) {
  for (const CellsParted how : {parted, CellsParted::by_blanks}) {
    std::vector<std::string> names = names_in(comment, how);
    const auto known =
        std::ranges::count_if(columns, [&](const Column& one) { return !places_of(one, names).empty(); });
    const bool is_full = names.size() == first.cells.size() && (known > 1 || how == CellsParted::by_commas);
    if (is_full || known == std::ssize(columns)) return names;
  }
  return {};
}

bool is_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::vector<TableLine> table_lines(std::string_view text, CellsParted parted, const std::string& name,
                                   std::vector<TableLine>* comments) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  std::vector<TableLine> lines;
  std::size_t cells = 0;
  for (int number = 1; !text.empty();) {
    std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = without_blanks(text.substr(0, end));
    const bool is_comment = line.starts_with('#');
    if (is_comment && comments != nullptr && lines.empty()) comments->push_back({number, {line.substr(1)}});
    if (!is_comment && !line.empty()) {
      end = end_of_line(text);
      line = without_blanks(text.substr(0, end));
      lines.push_back({number, cells_of(line, parted)});
      if (lines.back().cells.empty())
        fail_at_line(name, number, "quotation marks stand around a whole cell, commas between cells");
      cells += lines.back().cells.size();
      if (cells > maximum_cells) fail_at_line(name, number, "a table must have at most 16 million cells");
    }
    number += 1 + static_cast<int>(std::ranges::count(line, '\n'));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

NamedTable named_table(std::string_view text, CellsParted parted, const std::string& name,
                       std::span<const Column> columns) {
  std::vector<TableLine> above;
  NamedTable table{{}, table_lines(text, parted, name, &above)};
  if (table.lines.empty()) return table;
  std::vector<std::string> names;
  int head = 0;
  for (; names.empty() && !above.empty(); above.pop_back()) {
    names = names_in_comment(above.back().cells[0], table.lines.front(), parted, columns);
    head = above.back().number;
  }
  if (names.empty()) {
    for (const std::string_view cell : table.lines.front().cells) names.push_back(as_names(cell));
    if (std::ranges::all_of(columns, [&](const Column& one) { return places_of(one, names).empty(); }))
      return table;
    head = table.lines.front().number;
    table.lines.erase(table.lines.begin());
  }
  constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> places;
  for (const Column& column : columns) {
    const std::vector<std::size_t> found = places_of(column, names);
    std::string called(column.names);
    for (std::size_t at = 0; (at = called.find('|', at)) != std::string::npos;) called.replace(at, 1, ", ");
    if (found.size() > 1 || (found.empty() && !column.is_optional))
      fail_at_line(name, head,
                   "one column must be called " + called + ", found " + std::to_string(found.size()));
    places.push_back(found.empty() ? nowhere : found[0]);
    table.names.push_back(found.empty() ? "" : names[found[0]]);
    if (const std::string_view unit = unit_in(table.names.back());
        !unit.empty() && !is_among(unit, std::string(column.units)))
      fail_at_line(name, head, table.names.back() + ": must be in " + std::string(column.units));
    for (const std::string& one : names)
      if (column.is_optional && is_nearly(one, column.names, columns))
        fail_at_line(name, head, one + ": not a column that is read; " + called + " is");
  }
  for (TableLine& line : table.lines) {
    if (line.cells.size() != names.size())
      fail_at_line(name, line.number,
                   "expected " + std::to_string(names.size()) + " cells, as line " + std::to_string(head) +
                       " has names, found " + std::to_string(line.cells.size()));
    std::vector<std::string_view> cells;
    for (const std::size_t place : places)
      cells.push_back(place == nowhere ? std::string_view() : line.cells[place]);
    line.cells = std::move(cells);
  }
  return table;
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
