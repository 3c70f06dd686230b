#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace understory {

/// One line of a table in text: its cells, blanks around them removed, and its number for messages. The cells
/// view the text they were cut from.
struct TableLine {
  int number = 1;  ///< from 1
  std::vector<std::string_view> cells;
};

/// How a table separates its cells: at every comma, or at runs of blanks.
enum class CellsParted { by_commas, by_blanks };

/// The lines that are not empty; those that start with '#' are comments. Takes line ends of any system, and
/// cells in quotation marks, with commas and line ends within (RFC 4180); doubled marks within stay doubled.
/// `comments`: gets the comments before the first line, each as one cell. Throws InputError, with `name` for
/// the file, at more than 16 million cells, and at a quotation mark out of place.
std::vector<TableLine> table_lines(std::string_view text, CellsParted parted, const std::string& name,
                                   std::vector<TableLine>* comments = nullptr);

/// A column that a table must have: the names that it may have and the units that these may state, in lower
/// case, separated by '|'. "timestamp|t" and "ns|s".
struct Column {
  std::string_view names, units = "";
  bool is_optional = false;  ///< if it is missing its cells are empty
};

/// The lines of a table that may name its columns, in its first line or in a comment above the first line of
/// values: each with the cells of `columns` alone, in their order. If the table has no names, its columns
/// keep their order, and lines are as table_lines() gives them.
struct NamedTable {
  std::vector<std::string> names;  ///< of `columns`, as the table has them: "timestamp[ns]"; empty: none
  std::vector<TableLine> lines;
};

/// Throws InputError "name:line: ..." where the names lack one of `columns`, have it twice or in another
/// unit, and where a line has another number of cells than there are names.
NamedTable named_table(std::string_view text, CellsParted parted, const std::string& name,
                       std::span<const Column> columns);

/// The whole of `text` as a number, with or without a plus; nothing if it is not a number, does not fit, or
/// is not finite. Independent of the locale.
template <typename Number = double>
std::optional<Number> number_in(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars takes none
  Number value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

/// The whole cell as nanoseconds, a whole number from 0; nothing where it is none.
std::optional<std::int64_t> nanoseconds_in(std::string_view cell);

/// The whole cell as seconds from 0, in nanoseconds. Plain decimals are taken digit by digit, since a double
/// holds the seconds of this century to 0.2 us only; those with an exponent go through a double.
std::optional<std::int64_t> seconds_in(std::string_view cell);

/// Throws InputError "name:line: what was expected".
[[noreturn]] void fail_at_line(const std::string& name, int line, const std::string& expected);

}  // namespace understory
