#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
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
std::vector<TableLine> table_lines(std::string_view text, CellsParted parted);

/// The whole cell as a finite number; nothing where it is none.
std::optional<double> number_in(std::string_view cell);

/// The whole cell as nanoseconds, a whole number from 0; nothing where it is none.
std::optional<std::int64_t> nanoseconds_in(std::string_view cell);

/// The whole cell as seconds from 0, in nanoseconds. Plain decimals are taken digit by digit, since a double
/// holds the seconds of this century to 0.2 us only; those with an exponent go through a double.
std::optional<std::int64_t> seconds_in(std::string_view cell);

/// The file's text. Throws std::runtime_error "file: expected ..." where it cannot be read.
std::string text_of(const std::filesystem::path& file);

/// Throws std::runtime_error "name:line: what was expected".
[[noreturn]] void fail_at_line(const std::string& name, int line, const std::string& expected);

}  // namespace understory
