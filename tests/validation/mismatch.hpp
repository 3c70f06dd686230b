#pragma once

#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "sim/aircraft/aircraft_config.hpp"
#include "tests/validation/drift.hpp"

namespace understory {

/// One aircraft that differs from the stack's model.
struct MismatchCondition {
  std::string what = {};  ///< the curve it lies on; empty: the model itself
  double percent = 0;     ///< of the curve
  MismatchConfig mismatch = {};
  std::string name() const;
};

/// Every property adverse at once: `percent` heavier and more drag, less lift and less damping, and the delay
/// longer by five times as many percent.
MismatchConfig adverse(double percent);

/// What the page flies, the model itself first, then by curve.
std::vector<MismatchCondition> mismatch_conditions();

/// What flights over several seeds came to.
struct FlightTally {
  std::vector<Outcome> outcomes;   ///< one a flight
  double speed_sum_mps = 0;        ///< of each flight's mean, over ground
  DriftTally drift;                ///< of the estimate that flew
  std::vector<DriftTally> others;  ///< of other filters along the same flights

  int flights() const { return static_cast<int>(outcomes.size()); }
  int count(Outcome outcome) const;
  int goals() const { return count(Outcome::goal); }
  Interval success() const { return wilson_interval(goals(), flights()); }
  double mean_speed_mps() const { return speed_sum_mps / flights(); }
};

/// Seeds `first` .. `first + count - 1`.
struct Seeds {
  std::uint64_t first = 1000;
  int count = 10;
};

/// Flies `scenario` on true depth and its own filter, and follows how the errors of obstacles seen 10 m ahead
/// grow until they are passed, by the very estimate that flew, and by what `others` would have made of the
/// same flights' samples.
FlightTally fly_seeds(Scenario scenario, const std::vector<FilterConfig>& others, const Seeds& seeds);

}  // namespace understory
