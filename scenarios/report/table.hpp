#pragma once

#include <concepts>
#include <string>
#include <vector>

namespace understory {

inline std::string cell_text(std::string text) { return text; }
std::string cell_text(std::integral auto count) { return std::to_string(count); }

/// Cells of text, every row as long as the head.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows = {};

  /// A row of words and whole numbers.
  void add(const auto&... cells) { rows.push_back({cell_text(cells)...}); }
};

/// "-" where the value is no number.
std::string number_text(double value, int decimals);

/// Columns two spaces apart, for a terminal: the first to the left, the others to the right. Lines end where
/// their text does.
std::string to_text(const Table& table);

/// The same as Markdown, words to the left; a | in a cell is escaped.
std::string to_markdown(const Table& table);
/// Blanks in place of line breaks and other control characters.
std::string one_line(std::string text);

/// CSV as RFC 4180 has it, lines ended by \n alone: a cell with a comma, a quotation mark or a line break is
/// quoted.
std::string to_csv(const Table& table);

/// Reads it back, with line ends of any system. `name` stands for the file in messages. Throws ScenarioError
/// "name:line: expected ..." where a row is not as long as the head or a quotation mark is out of place.
Table table_from_csv(const std::string& text, const std::string& name);

}  // namespace understory
