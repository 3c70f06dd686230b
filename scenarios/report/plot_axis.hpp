#pragma once

#include <vector>

namespace understory {

struct AxisRange {
  double minimum = 0;
  double maximum = 1;
};

/// Widens `range` to hold `value`, if that is a number.
void include(AxisRange& range, double value);
/// A little more than `range`, so that nothing lies on the frame; something to show where it is empty.
AxisRange padded(AxisRange range);

/// Between ticks: 1, 2 or 5 times a power of ten, so that about `wanted` stand in `range`.
double tick_step(AxisRange range, int wanted);
/// Where ticks stand: the multiples of that step.
std::vector<double> tick_positions(AxisRange range, int wanted);
/// Digits behind the point that a tick's label needs.
int decimals(double step);

}  // namespace understory
