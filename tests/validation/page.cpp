#include "tests/validation/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string asked(const Check& check) { return check.relation + " " + with_unit(check.limit, check.unit); }

/// What stands in each block of the page, by SECTION.BLOCK.
std::map<std::string, std::string> blocks_of(const std::vector<Section>& sections) {
  std::map<std::string, std::string> blocks;
  for (Section section : sections) {
    for (const Check& check : section.checks)
      section.row("checks",
                  fmt::format("{} | {} | {} | {}", check.what, with_unit(check.measured, check.unit),
                              asked(check), check.holds ? "ok" : "**broken**"));
    for (const auto& [name, content] : section.blocks) blocks[section.name + "." + name] = content;
  }
  return blocks;
}

/// The table `old` with other rows: its header and the line beneath it stay.
std::string with_rows(const std::string& old, const std::string& rows) {
  const std::size_t header = old.find('\n', 1), beneath = old.find('\n', header + 1);
  if (header == std::string::npos || beneath == std::string::npos)
    throw ScenarioError("expected the two lines of a table's header");
  const auto cells = [](std::string_view line) { return std::count(line.begin(), line.end(), '|'); };
  std::istringstream lines(rows);
  for (std::string line; std::getline(lines, line);)
    if (cells(line) != cells(old.substr(0, header)))
      throw ScenarioError("expected as many cells as in the table's header: " + line);
  return old.substr(0, beneath + 1) + rows;
}

}  // namespace

Check at_most(const std::string& what, double measured, double limit, const std::string& unit) {
  return {what, measured, "at most", limit, unit, measured <= limit};
}

Check at_least(const std::string& what, double measured, double limit, const std::string& unit) {
  return {what, measured, "at least", limit, unit, measured >= limit};
}

Check within(const std::string& what, double measured, double tolerance, double limit,
             const std::string& unit) {
  const bool holds = std::abs(measured - limit) <= tolerance;
  return {what, measured, fmt::format("within {:.3g} of", tolerance), limit, unit, holds};
}

std::string lines_of(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& check : checks)
    text += fmt::format("{:<7} {}: {}, asked {}\n", check.holds ? "ok" : "broken", check.what,
                        with_unit(check.measured, check.unit), asked(check));
  return text;
}

std::string filled(const std::string& page, const std::vector<Section>& sections) {
  static const std::regex opening("<!-- ([a-z_]+\\.[a-z_]+) -->");
  static const std::string closing = "<!-- end -->";
  const std::map<std::string, std::string> blocks = blocks_of(sections);
  std::set<std::string> missing;
  for (const auto& [name, content] : blocks) missing.insert(name);
  std::string text;
  auto rest = page.cbegin();
  for (std::smatch found; std::regex_search(rest, page.cend(), found, opening);) {
    const std::string name = found[1];
    const auto content = found[0].second,
               end = std::search(content, page.cend(), closing.begin(), closing.end());
    const auto block = blocks.find(name);
    if (block == blocks.end()) throw ScenarioError(name + ": in the page, but not measured");
    if (end == page.cend()) throw ScenarioError(name + ": expected <!-- end --> after it");
    const std::string old(content, end);
    text.append(rest, content);
    text += old.starts_with("\n|") ? with_rows(old, block->second) : block->second;
    missing.erase(name);
    rest = end;
  }
  for (const Section& section : sections)
    for (const auto& [name, svg] : section.pictures)
      if (page.find("/" + name + ".svg)") == std::string::npos) missing.insert(name + ".svg");
  if (!missing.empty()) throw ScenarioError(*missing.begin() + ": measured, but not in the page");
  return text.append(rest, page.cend());
}

bool agree(const std::string& a, const std::string& b) {
  static const std::regex number("[-+]?[0-9]+(\\.[0-9]+)?(e[-+][0-9]+)?");
  if (std::regex_replace(a, number, "#") != std::regex_replace(b, number, "#")) return false;
  std::sregex_iterator of_a(a.begin(), a.end(), number), of_b(b.begin(), b.end(), number);
  for (const std::sregex_iterator end; of_a != end && of_b != end; ++of_a, ++of_b) {
    const double x = std::stod(of_a->str()), y = std::stod(of_b->str());
    const auto digits = std::max<long>(0, of_a->length(1) - 1);  // behind the point
    const double last_digit = of_a->length(2) > 0 ? 1e-9 : std::pow(10, -digits);
    if (std::abs(x - y) > std::max(0.02 * std::abs(x), 1.01 * last_digit)) return false;
  }
  return true;
}

}  // namespace understory
