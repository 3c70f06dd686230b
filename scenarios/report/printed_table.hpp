#pragma once

#include <string>
#include <vector>

namespace understory {

/// Cells of text, every row as long as the head.
struct PrintedTable {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// Columns two spaces apart, for a terminal: the first to the left, the others to the right. Lines end where
/// their text does.
std::string to_text(const PrintedTable& table);

/// The same as Markdown; a | in a cell is escaped.
std::string to_markdown(const PrintedTable& table);

}  // namespace understory
