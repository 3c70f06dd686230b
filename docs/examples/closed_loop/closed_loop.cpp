// A closed loop of one's own around a flight: a detector that is handed in, and a look at every frame.
//
//   closed_loop FOLDER SEED      FOLDER: share/understory of the installation
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

int main(int argc, char** argv) try {
  using namespace understory;
  if (argc != 3) return std::fprintf(stderr, "closed_loop FOLDER SEED\n"), 2;
  const std::filesystem::path data = argv[1];
  const Scenario scenario =
      load_scenario(data / "scenarios/library/forest.yaml", {std::string("seed=") + argv[2]});
  const FlightMachine machine{data / "models"};
  FlightParts parts;
  parts.detector = std::make_unique<PushbroomStereo>(rig_of(scenario, machine.models_folder).rig,
                                                     scenario.perception.pushbroom());
  FlightLogger logger;
  Flight flight(scenario, machine, {&logger}, std::move(parts));
  while (!flight.outcome()) {
    flight.step();
    if (flight.clock().step() % 1200 == 0)
      std::printf("%.0f s: x = %.1f m, %zu points in the map\n", flight.clock().t_s(),
                  flight.truth().T_world_body.translation().x(), flight.map().points().size());
  }
  std::printf("%s\n", to_report(logger.log().result).c_str());
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "closed_loop: %s\n", error.what()), 2;
}
