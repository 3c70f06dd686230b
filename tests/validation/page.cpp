#include "tests/validation/page.hpp"

#include <fmt/format.h>

#include <cmath>

#include "perception/assertion.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

Check check(const std::string& what, double measured, std::string relation, double limit,
            const std::string& unit, bool holds) {
  return {what, measured, std::move(relation), limit, unit, holds};
}

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string asked(const Check& check) { return check.relation + " " + with_unit(check.limit, check.unit); }

std::string checks_table(const std::vector<Check>& checks) {
  std::vector<std::vector<std::string>> rows;
  for (const Check& check : checks)
    rows.push_back(
        {check.what, with_unit(check.measured, check.unit), asked(check), check.holds ? "ok" : "**broken**"});
  return markdown_table({"check", "measured", "asked", ""}, rows);
}

}  // namespace

Check at_most(const std::string& what, double measured, double limit, const std::string& unit) {
  return check(what, measured, "at most", limit, unit, measured <= limit);
}

Check at_least(const std::string& what, double measured, double limit, const std::string& unit) {
  return check(what, measured, "at least", limit, unit, measured >= limit);
}

Check within(const std::string& what, double measured, double tolerance, double limit,
             const std::string& unit) {
  return check(what, measured, fmt::format("within {:.3g} of", tolerance), limit, unit,
               std::abs(measured - limit) <= tolerance);
}

std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows) {
  std::string text = "|";
  for (const std::string& cell : header) text += fmt::format(" {} |", cell);
  text += "\n|";
  for (std::size_t i = 0; i < header.size(); ++i) text += "---|";
  for (const std::vector<std::string>& row : rows) {
    assert_always(row.size() == header.size(), "a table's rows are as long as its header");
    text += "\n|";
    for (const std::string& cell : row) text += fmt::format(" {} |", cell);
  }
  return text + "\n";
}

std::string to_markdown(const ValidationPage& page) {
  std::string text = fmt::format("# {}\n\n{}\n", page.title, page.introduction);
  for (const Section& section : page.sections) {
    text += fmt::format("\n## {}\n\n{}\n", section.title, section.markdown);
    for (const Figure& figure : section.figures)
      text += fmt::format("\n![{0}]({1}/{2}.svg)\n\n{0}\n", figure.caption, page.file, figure.name);
    if (!section.checks.empty()) text += fmt::format("\n{}", checks_table(section.checks));
  }
  return text;
}

std::string check_lines(const ValidationPage& page) {
  std::string text;
  for (const Section& section : page.sections) {
    for (const Check& check : section.checks)
      text += fmt::format("{:<7} {}: {}, asked {}\n", check.holds ? "ok" : "broken", check.what,
                          with_unit(check.measured, check.unit), asked(check));
  }
  return text;
}

int broken_checks(const ValidationPage& page) {
  int broken = 0;
  for (const Section& section : page.sections)
    for (const Check& check : section.checks) broken += check.holds ? 0 : 1;
  return broken;
}

void write_page(const ValidationPage& page, const std::filesystem::path& folder) {
  prepare_output_folder(folder / page.file);
  for (const Section& section : page.sections)
    for (const Figure& figure : section.figures)
      write_whole_file(folder / page.file / (figure.name + ".svg"), figure.svg);
  write_whole_file(folder / (page.file + ".md"), to_markdown(page));
}

}  // namespace understory
