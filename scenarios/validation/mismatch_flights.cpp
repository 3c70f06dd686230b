#include "scenarios/validation/mismatch_flights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenarios/validation/recorded_flight.hpp"

namespace understory {
namespace {

constexpr double sight_m = 10;  // the long rig's detection depth, and the distance the drift goals speak of

/// How `filter` drifts along the flight's own samples: the same sensors, faults and seed as fly() had.
std::vector<Drift> drifts_with(const FilterConfig& filter, const RecordedFlight& flight) {
  TrialConfig config;
  config.filter = filter;
  config.sensors = flight.scenario.sensors.sensors;
  config.faults = flight.scenario.faults;
  config.sensor_seed = flight.scenario.sensor_seed();
  return drifts(flight, run_trial(flight, config), sight_m);
}

}  // namespace

void DriftTally::add(const std::vector<Drift>& drifts) {
  for (const Drift& drift : drifts) {
    total_m.push_back(drift.total_m());
    squared_sum_m2 += drift.total_m() * drift.total_m();
    stated_squared_sum_m2 += drift.stated_sigma_m * drift.stated_sigma_m;
  }
}

double DriftTally::quantile_m(double share) const {
  if (total_m.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = total_m;
  std::sort(sorted.begin(), sorted.end());
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double above = sorted[std::min(below + 1, sorted.size() - 1)];
  return std::lerp(sorted[below], above, place - std::floor(place));
}

double DriftTally::over_stated() const { return std::sqrt(squared_sum_m2 / stated_squared_sum_m2); }

int FlightTally::count(Ending ending) const {
  return static_cast<int>(std::count(endings.begin(), endings.end(), ending));
}

double FlightTally::mean_speed_mps() const {
  return std::accumulate(speed_mps.begin(), speed_mps.end(), 0.0) / static_cast<double>(speed_mps.size());
}

FlightTally fly_seeds(const Scenario& scenario, const std::vector<FilterConfig>& others, const Seeds& seeds,
                      const std::filesystem::path& models_folder) {
  FlightTally tally;
  tally.others.resize(others.size());
  Scenario seeded = scenario;
  for (int i = 0; i < seeds.count; ++i) {
    seeded.seed = seeds.first + static_cast<std::uint64_t>(i);
    const RecordedFlight flight = recorded_flight(seeded, models_folder, StateKind::filter);
    tally.endings.push_back(flight.result.ending);
    tally.speed_mps.push_back(flight.result.mean_speed_mps);
    tally.drift.add(drifts_with(seeded.estimation.filter, flight));
    for (std::size_t other = 0; other < others.size(); ++other)
      tally.others[other].add(drifts_with(others[other], flight));
  }
  return tally;
}

}  // namespace understory
