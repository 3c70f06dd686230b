#include "tests/validation/mismatch_flights.hpp"

#include <algorithm>
#include <numeric>

#include "tests/validation/recorded_flight.hpp"

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
