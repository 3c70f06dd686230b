#include "scenarios/report/plot_axis.hpp"

#include <algorithm>
#include <cmath>

namespace understory {

void include(AxisRange& range, double value) {
  if (!std::isfinite(value)) return;
  range.minimum = std::min(range.minimum, value);
  range.maximum = std::max(range.maximum, value);
}

AxisRange padded(AxisRange range) {
  if (range.minimum > range.maximum) return {0, 1};  // nothing to show
  const double room = range.maximum > range.minimum ? 0.05 * (range.maximum - range.minimum)
                                                    : std::max(0.5 * std::abs(range.minimum), 0.5);
  return {range.minimum - room, range.maximum + room};
}

double tick_step(AxisRange range, int wanted) {
  const double rough = (range.maximum - range.minimum) / std::max(1, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

std::vector<double> tick_positions(AxisRange range, int wanted) {
  const double step = tick_step(range, wanted);
  std::vector<double> ticks;
  for (double n = std::ceil(range.minimum / step - 1e-9); n * step <= range.maximum + 1e-9 * step; ++n)
    ticks.push_back(n == 0 ? 0.0 : n * step);  // no "-0"
  return ticks;
}

int decimals(double step) { return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9))); }

}  // namespace understory
