#include "scenarios/validation/mismatch_flights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenarios/validation/estimator_trial.hpp"
#include "scenarios/validation/recorded_flight.hpp"

namespace understory {
namespace {

constexpr double sight_m = 10;  // the long rig's detection depth, and the distance the drift goals speak of

/// The flight's own filter along the flight's own samples: the same sensors, faults and seed as fly() had.
TrialConfig as_flown(const Scenario& scenario) {
  TrialConfig config;
  config.filter = scenario.estimation.filter;
  config.sensors = scenario.sensors.sensors;
  config.faults = scenario.faults;
  config.sensor_seed = scenario.sensor_seed();
  return config;
}

}  // namespace

int FlightTally::count(Ending ending) const {
  return static_cast<int>(std::count(endings.begin(), endings.end(), ending));
}

double FlightTally::mean_speed_mps() const {
  return std::accumulate(speed_mps.begin(), speed_mps.end(), 0.0) / static_cast<double>(speed_mps.size());
}

double FlightTally::drift_quantile_m(double share) const {
  if (drift_m.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = drift_m;
  std::sort(sorted.begin(), sorted.end());
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double above = sorted[std::min(below + 1, sorted.size() - 1)];
  return std::lerp(sorted[below], above, place - std::floor(place));
}

double FlightTally::drift_over_stated() const {
  return std::sqrt(drift_squared_sum_m2 / stated_squared_sum_m2);
}

FlightTally fly_seeds(const Scenario& scenario, std::uint64_t first, int count,
                      const std::filesystem::path& models_folder) {
  FlightTally tally;
  Scenario seeded = scenario;
  for (int i = 0; i < count; ++i) {
    seeded.seed = first + static_cast<std::uint64_t>(i);
    const RecordedFlight flight = recorded_flight(seeded, models_folder, StateKind::filter);
    tally.endings.push_back(flight.result.ending);
    tally.speed_mps.push_back(flight.result.mean_speed_mps);
    for (const Drift& drift : drifts(flight, run_trial(flight, as_flown(flight.scenario)), sight_m)) {
      tally.drift_m.push_back(drift.total_m());
      tally.drift_squared_sum_m2 += drift.total_m() * drift.total_m();
      tally.stated_squared_sum_m2 += drift.stated_sigma_m * drift.stated_sigma_m;
    }
  }
  return tally;
}

}  // namespace understory
