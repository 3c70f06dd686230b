#include <algorithm>

#include "tests/validation/mismatch_sections.hpp"

namespace understory {

Series curve(const std::vector<FlownCondition>& all, const std::string& what, const Measure& measure) {
  std::vector<std::pair<double, double>> points{{0, measure(all.front().tally)}};
  for (const FlownCondition& flown : all)
    if (flown.condition.what == what)
      points.emplace_back(flown.condition.percent / (what == "delay" ? 5 : 1), measure(flown.tally));
  std::sort(points.begin(), points.end());
  Series series{what};
  series.mark = Mark::line_and_dots;
  for (const auto& [x, y] : points) {
    series.x.push_back(x);
    series.y.push_back(y);
  }
  return series;
}

LinePlot curves(const std::vector<FlownCondition>& all, const std::string& title, const std::string& y_label,
                const Measure& measure) {
  LinePlot plot{title, "mismatch (%; of the delay: a fifth)", y_label};
  for (const char* what : {"mass", "lift", "drag", "damping", "delay", adverse_name})
    plot.series.push_back(curve(all, what, measure));
  return plot;
}

}  // namespace understory
