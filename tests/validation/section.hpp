#pragma once

#include <string>
#include <vector>

namespace understory {

/// One stated tolerance, and what was measured against it.
struct Check {
  std::string what = {};
  double measured = 0;
  std::string relation = {};  ///< between measured and limit: "at most", "at least", "within 0.1 of"
  double limit = 0;
  std::string unit = {};
  bool holds = false;  ///< false too where nothing could be measured (NaN)
};

Check at_most(const std::string& what, double measured, double limit, const std::string& unit);
Check at_least(const std::string& what, double measured, double limit, const std::string& unit);
Check within(const std::string& what, double measured, double tolerance, double limit,
             const std::string& unit);

/// A picture of a page, written beside it as `name`.svg.
struct Figure {
  std::string name = {};
  std::string caption = {};
  std::string svg = {};
};

/// One subject of a page: what was done and found, in words and tables; its figures; its tolerances.
struct Section {
  std::string title = {};
  std::string markdown = {};
  std::vector<Figure> figures = {};
  std::vector<Check> checks = {};
};

/// What `./run validate` writes as one file: FILE.md, its figures in the folder FILE beside it. Nothing
/// in it may depend on the clock or the machine's speed: the page is committed, and made again it should
/// differ only where the program does.
struct ValidationPage {
  std::string file = {};  ///< without .md
  std::string title = {};
  std::string introduction = {};
  std::vector<Section> sections = {};
};

}  // namespace understory
