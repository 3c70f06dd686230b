#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
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

/// How a table parts its cells: at every comma, or at runs of blanks.
enum class CellsParted { by_commas, by_blanks };

/// The lines that hold anything; those that start with '#' are comments. Takes line ends of any system.
/// Throws InputError, with `name` for the file, at more than 16 million cells.
std::vector<TableLine> table_lines(std::string_view text, CellsParted parted, const std::string& name);

/// The whole of `text` as a number, a plus before it or not; nothing where it is none, does not fit, or is
/// not finite. Whatever the locale.
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
