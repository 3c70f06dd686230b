#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/report/line_plot.hpp"
#include "tests/validation/mismatch_conditions.hpp"
#include "tests/validation/mismatch_flights.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// The share of remembered obstacles whose drift is below the one that is told.
inline constexpr double drift_share = 0.95;

struct FlownCondition {
  MismatchCondition condition;
  FlightTally tally;
  AxisRange level_mps;  ///< where the aircraft flies level at all; nowhere: the least above the greatest
};

/// One that the flights' samples are given to beside the filter that flew.
struct OtherFilter {
  const char* name;
  FilterConfig filter;
};

inline bool flies_level(const FlownCondition& flown) {
  return flown.level_mps.minimum <= flown.level_mps.maximum;
}

using Measure = std::function<double(const FlightTally&)>;

/// One condition's curve over its percent, through the model itself (the first of `all`) at 0. The delay's
/// percent are drawn five times closer, as the adverse aircraft has them.
Series curve(const std::vector<FlownCondition>& all, const std::string& what, const Measure& measure);

/// The curves of every property.
LinePlot curves(const std::vector<FlownCondition>& all, const std::string& title, const std::string& y_label,
                const Measure& measure);

/// The sections of the page on model mismatch. The model itself is the first of `all`; `others` are in the
/// order of FlightTally::others.
Section mismatch_success_section(const std::vector<FlownCondition>& all);
Section mismatch_drift_section(const std::vector<FlownCondition>& all,
                               const std::vector<OtherFilter>& others);

}  // namespace understory
