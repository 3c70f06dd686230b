#include "tests/validation/recorded_flight.hpp"

#include <cmath>

#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

struct TruthKeeper : FlightObserver {
  void on_step(const Flight& flight) override { truths.push_back(flight.truth()); }
  std::vector<Truth> truths;
};

}  // namespace

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
  TruthKeeper keeper;
  options.observers = {&keeper};
  flight.result = fly(flight.scenario, options);
  flight.truths = std::move(keeper.truths);
  const LaunchConfig& launch = scenario.launch;
  const double stroke_s = 2 * launch.rail_length_m / launch.speed_mps;
  flight.release_step = std::llround((launch.rest_s + stroke_s) * physics_rate_hz);
  return flight;
}

}  // namespace understory
