#include "perception/io/machine_limits.hpp"
#include "scenarios/flight/flight.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "perception/io/text_file.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/config/field_writer.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/actions.hpp"
#include "scenarios/flight/ideal_parts.hpp"
#include "scenarios/parts/checked_parts.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
World world_of(const Scenario& scenario, const std::filesystem::path& models_folder) {
  require_stack();
  const Wood wood = course_wood(scenario);
  try {
    WorldConfig config = scenario.world_config();
    config.woods = woods_of(scenario);
    return build_world(models_folder, scenario.flown_airframe(), wood.obstacles, config, wood.trees,
                       scenario.course_rectangle());
  } catch (const SimulationError& error) {
    if (write_config(scenario.airframe) == write_config(Airframe())) throw MachineError(error.what());
    throw ScenarioError(fmt::format("{}: airframe: {}", scenario.name, error.what()));
  } catch (const std::runtime_error& error) {
    throw MachineError(error.what());  // the models are the project's, not the caller's
  }
}

std::unique_ptr<StereoCameras> cameras_of(const Scenario& scenario, const World& world,
                                          const CalibratedRig& rig, RendererKind renderer) {
  const CameraSeeds seeds{seed_for(scenario.sensor_seed(), "cameras"),
                          seed_for(scenario.sensor_seed(), "camera_shot_noise")};
  // llvmpipe ends with a signal where it gets no memory for its code.
  constexpr std::size_t drawing_bytes = std::size_t{320} << 20;
  require_address_space(drawing_bytes, "drawing");
  try {
    return std::make_unique<StereoCameras>(world, rig.rig, scenario.cameras, seeds, rig.calibration,
                                           renderer);
  } catch (const std::runtime_error& error) {
    const std::string lacking = lacking_resource();
    throw MachineError(error.what() + (lacking.empty() ? "" : ": " + lacking));
  }
}

Aircraft aircraft_of(const Scenario& scenario, const World& world) {
  try {
    const Wind wind(scenario.wind_world_mps, scenario.wind, scenario.stand(),
                    seed_for(scenario.seed, "wind"));
    return Aircraft(world.flown_model(), scenario.flown_airframe(), scenario.launch, wind, scenario.actuators,
                    scenario.forest.intangible ? std::vector<Obstacle>{} : world.obstacles);
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

std::unique_ptr<ObstacleDetector> detector_of(const Scenario& scenario, const CalibratedRig& rig,
                                              const std::vector<Obstacle>& obstacles,
                                              const TruthHistory& history) {
  const DetectorPart& part = scenario.perception.part();
  auto detector = checked(part, {scenario, rig, obstacles, history, seed_for(scenario.seed, "detector")});
  const std::string& hits = scenario.ideal.hits;
  if (hits.empty()) return detector;
  return bad_input_if_refused([&]() -> std::unique_ptr<ObstacleDetector> {
    return std::make_unique<KnownDetector>(known_hits_from_bytes(read_file(hits, maximum_table_bytes), hits),
                                           nanoseconds(scenario.ideal.from_s), std::move(detector));
  });
}

std::unique_ptr<StateSource> state_source_of(const Scenario& scenario, const CalibratedRig& rig,
                                             const std::vector<Obstacle>& obstacles,
                                             const TruthHistory& history) {
  const StateSourcePart& part = *parts().state_sources.find(scenario.estimation.source);
  return checked(part, {scenario, rig, obstacles, history, seed_for(scenario.seed, "state_source")});
}

std::unique_ptr<Planner> planner_of(const Scenario& scenario) {
  const AutopilotSection& autopilot = scenario.autopilot;
  const FlightModel model(scenario.airframe, autopilot.flight_model);
  const Mission mission = scenario.mission();
  const PlannerPart& part = *parts().planners.find(autopilot.method);
  const PlannerContext context{autopilot.planner, model, mission,
                               seed_for(scenario.planner_seed(), "planner")};
  return checked(part, {context, scenario});
}

std::unique_ptr<Pilot> pilot_of(const Scenario& scenario) {
  const std::string& file = scenario.autopilot.actions;
  if (file.empty()) return nullptr;
  return bad_input_if_refused([&] {
    return std::make_unique<RecordedPilot>(parse_actions(read_file(file, maximum_table_bytes), file));
  });
}

AutopilotConfig autopilot_config_of(const Scenario& scenario, const StereoRig& rig) {
  AutopilotConfig config = scenario.autopilot;
  config.resightings.depths_m = stated_depths_m(scenario.perception.pushbroom(), rig);
  config.plan_cost = scenario.perception.compute.plan_cost(scenario.sensors.imu_rate_hz);
  return config;
}

}  // namespace understory
