#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenarios/evaluation/wilson.hpp"
#include "scenarios/flight_result.hpp"
#include "scenarios/scenario.hpp"

namespace understory {

/// What flights over several seeds came to.
struct FlightTally {
  std::vector<Ending> endings;    ///< one a flight
  std::vector<double> speed_mps;  ///< mean of each flight, over ground
  std::vector<double> drift_m;  ///< every remembered obstacle's, 10 m ahead to passing, all flights together
  double drift_squared_sum_m2 = 0,
         stated_squared_sum_m2 = 0;  ///< over `drift_m`: true, and as the filter says

  int flights() const { return static_cast<int>(endings.size()); }
  int count(Ending ending) const;
  Interval success() const { return wilson_interval(count(Ending::goal), flights()); }
  double mean_speed_mps() const;
  /// The drift that `share` of the obstacles stay below; NaN without any.
  double drift_quantile_m(double share) const;
  /// RMS of the drift over the RMS that the filter's covariance states: 1 is honest, more overconfident.
  double drift_over_stated() const;
};

/// Flies `scenario` on true depth and its own filter with the seeds `first` .. `first + count - 1`, and
/// follows how the errors of obstacles seen 10 m ahead grow until they are passed, by the very estimate that
/// flew.
FlightTally fly_seeds(const Scenario& scenario, std::uint64_t first, int count,
                      const std::filesystem::path& models_folder);

}  // namespace understory
