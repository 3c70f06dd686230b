#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "tests/validation/drift_tally.hpp"

namespace understory {

/// What flights over several seeds came to.
struct FlightTally {
  std::vector<Ending> endings;     ///< one a flight
  std::vector<double> speed_mps;   ///< mean of each flight, over ground
  DriftTally drift;                ///< of the estimate that flew
  std::vector<DriftTally> others;  ///< of other filters along the same flights

  int flights() const { return static_cast<int>(endings.size()); }
  int count(Ending ending) const;
  int goals() const { return count(Ending::goal); }
  Interval success() const { return wilson_interval(goals(), flights()); }
  double mean_speed_mps() const;
};

/// Seeds `first` .. `first + count - 1`.
struct Seeds {
  std::uint64_t first = 1000;
  int count = 10;
};

/// Flies `scenario` on true depth and its own filter, and follows how the errors of obstacles seen 10 m ahead
/// grow until they are passed, by the very estimate that flew, and by what `others` would have made of the
/// same flights' samples.
FlightTally fly_seeds(const Scenario& scenario, const std::vector<FilterConfig>& others, const Seeds& seeds,
                      const std::filesystem::path& models_folder);

}  // namespace understory
