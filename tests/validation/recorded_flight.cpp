#include "tests/validation/recorded_flight.hpp"

#include <cmath>

#include "scenarios/flight/fly.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {

RecordedFlight recorded_flight(const Scenario& scenario, const std::filesystem::path& models_folder,
                               StateKind flown_on) {
  RecordedFlight flight;
  flight.scenario = scenario;
  flight.scenario.perception.detector = DetectorKind::true_depth;
  flight.scenario.estimation.source = flown_on;
  flight.rig = rig_of(flight.scenario, models_folder).rig;
  flight.obstacles = course_obstacles(flight.scenario);
  FlyOptions options;
  options.models_folder = models_folder;
  options.on_truth = [&](const Truth& truth) { flight.truths.push_back(truth); };
  flight.result = fly(flight.scenario, options);
  const LaunchConfig& launch = scenario.launch;
  const double stroke_s = 2 * launch.rail_length_m / launch.speed_mps;
  flight.release_step = std::llround((launch.rest_s + stroke_s) * physics_rate_hz);
  return flight;
}

}  // namespace understory
