#include "scenarios/report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

/// In letters: UTF-8's continuation bytes take no room.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string text_line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t column = 0; column < cells.size(); ++column) {
    const std::string room(widths[column] - width_of(cells[column]), ' '), cell = one_line(cells[column]);
    line += column == 0 ? cell + room : "  " + room + cell;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string markdown_line(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += ' ';
    for (const char c : one_line(cell)) line += c == '|' ? std::string("\\|") : std::string(1, c);
    line += " |";
  }
  return line + "\n";
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    if (cell.find_first_of(",\"\r\n") == std::string::npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

/// Takes one cell from `at` on and leaves `at` behind it; nothing where a quotation mark is out of place.
std::optional<std::string> take_cell(const std::string& text, std::size_t& at) {
  const std::size_t begin = at;
  std::string cell;
  while (at < text.size() && text[at] == '"') {
    if (at > begin) cell += '"';  // two of them stand for one
    const std::size_t end = text.find('"', at + 1);
    if (end == std::string::npos) return {};
    cell += text.substr(at + 1, end - at - 1);
    at = end + 1;
  }
  const std::size_t end = std::min(text.find_first_of(",\r\n", at), text.size());
  const std::string plain = text.substr(at, end - at);
  if (plain.find('"') != std::string::npos || (at > begin && !plain.empty())) return {};
  at = end;
  return cell + plain;
}

}  // namespace

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  return text;
}

std::string number_text(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : table.head) widths.push_back(width_of(cell));
  for (const auto& row : table.rows)
    for (std::size_t column = 0; column < row.size(); ++column)
      widths[column] = std::max(widths[column], width_of(row[column]));
  std::string text = text_line(table.head, widths);
  for (const auto& row : table.rows) text += text_line(row, widths);
  return text;
}

std::string to_markdown(const Table& table) {
  std::string text = markdown_line(table.head) + "|";
  for (std::size_t column = 0; column < table.head.size(); ++column) {
    const bool has_words = std::ranges::any_of(table.rows, [&](const std::vector<std::string>& row) {
      return !row[column].empty() && std::isalpha(static_cast<unsigned char>(row[column][0]));
    });
    text += column == 0 || has_words ? "---|" : "---:|";
  }
  text += "\n";
  for (const auto& row : table.rows) text += markdown_line(row);
  return text;
}

std::string to_csv(const Table& table) {
  std::string text = csv_line(table.head);
  for (const auto& row : table.rows) text += csv_line(row);
  return text;
}

Table table_from_csv(const std::string& text, const std::string& name) {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = at;
    const auto refuse = [&](const std::string& expected) {
      const auto breaks = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
      throw ScenarioError(fmt::format("{}:{}: expected {}", name, breaks + 1, expected));
    };
    std::vector<std::string>& cells = lines.emplace_back();
    do {
      if (!cells.empty()) ++at;  // the comma
      const std::optional<std::string> cell = take_cell(text, at);
      if (!cell) refuse("quotation marks around a whole cell and twice within it");
      cells.push_back(*cell);
    } while (at < text.size() && text[at] == ',');
    if (cells.size() != lines.front().size())
      refuse(fmt::format("a whole row of {} values", lines.front().size()));
    if (text.compare(at, 2, "\r\n") == 0) ++at;
    ++at;
  }
  if (lines.empty()) return {};
  Table table{std::move(lines.front())};
  table.rows.assign(std::make_move_iterator(lines.begin() + 1), std::make_move_iterator(lines.end()));
  return table;
}

}  // namespace understory
