#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "scenarios/report/line_plot.hpp"

namespace understory {

constexpr double degree = std::numbers::pi / 180;

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
/// A line for each check, as the terminal shows it.
std::string lines_of(const std::vector<Check>& checks);

/// Widens a range that began as HUGE_VAL .. -HUGE_VAL.
inline void include(AxisRange& range, double value) {
  range = {std::min(range.minimum, value), std::max(range.maximum, value)};
}

/// What was measured for one section of a page in docs/. Nothing in it may depend on the clock or the
/// machine's speed.
struct Section {
  std::string name;                                  ///< begins the names of its blocks
  std::map<std::string, std::string> blocks = {};    ///< a figure as the page shows it, or a table's rows
  std::map<std::string, std::string> pictures = {};  ///< SVG, by name
  std::vector<Check> checks = {};                    ///< the rows of the block "checks"

  /// One more row of a table, cells apart by " | ".
  void row(const std::string& table, const std::string& cells) { blocks[table] += "| " + cells + " |\n"; }
};

/// The page with its blocks filled. A page is written by hand, but for what stands between
/// `<!-- SECTION.BLOCK -->` and `<!-- end -->`: a figure within a sentence, or the rows of a table, whose two
/// lines of header stay. Throws ScenarioError, naming page and block, where page and `sections` do not have
/// the same blocks and pictures (each shown once or more), or a row not the cells of its header.
std::string filled(const std::string& page, const std::vector<Section>& sections);

/// Whether two pages or pictures say the same: numbers may be apart by 2 % or by one in their last digit, as
/// processors round differently.
bool agree(const std::string& a, const std::string& b);

/// One point for each item; where x or y is nan, none. `x` and `y`: members or functions of an item.
template <typename Items, typename X, typename Y>
Series plotted(const std::string& name, const Items& items, X&& x, Y&& y, Mark mark = Mark::line,
               int colour = -1) {
  Series series{name};
  series.mark = mark;
  series.colour = colour;
  for (const auto& item : items) {
    const double across = std::invoke(x, item), up = std::invoke(y, item);
    if (std::isnan(across) || std::isnan(up)) continue;
    series.x.push_back(across);
    series.y.push_back(up);
  }
  return series;
}

}  // namespace understory
