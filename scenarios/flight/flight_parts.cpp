#include "scenarios/flight/flight.hpp"

#include <stdexcept>
#include <utility>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "planning/planners/planners.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
World world_of(const Scenario& scenario, const std::filesystem::path& models_folder,
               const std::vector<Obstacle>& obstacles) {
  try {
    return build_world(models_folder, scenario.flown_airframe(), obstacles, scenario.world_config());
  } catch (const std::runtime_error& error) {
    throw MachineError(error.what());  // the models are the project's, not the caller's
  }
}

std::unique_ptr<StereoCameras> cameras_of(const Scenario& scenario, const World& world,
                                          const CalibratedRig& rig, RendererKind renderer) {
  const CameraSeeds seeds{seed_for(scenario.sensor_seed(), "cameras"),
                          seed_for(scenario.sensor_seed(), "camera_shot_noise")};
  try {
    return std::make_unique<StereoCameras>(world, rig.rig, scenario.cameras.cameras, seeds, rig.calibration,
                                           renderer);
  } catch (const std::runtime_error& error) {
    throw MachineError(error.what());
  }
}

Aircraft aircraft_of(const Scenario& scenario, const World& world) {
  try {
    const Wind wind(scenario.wind_world_mps, scenario.wind, scenario.stand(),
                    seed_for(scenario.seed, "wind"));
    return Aircraft(*world.model, scenario.flown_airframe(), scenario.launch, wind, scenario.actuators);
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

std::unique_ptr<ObstacleDetector> detector_of(const Scenario& scenario, const CalibratedRig& rig,
                                              const std::vector<Obstacle>& obstacles,
                                              const TruthHistory& history) {
  const PerceptionSection& perception = scenario.perception;
  if (perception.detector == "pushbroom")
    check_depths(perception.pushbroom(), rig.rig, "perception.depths_m", "perception.pushbroom");
  return scenario.parts->detectors.find(perception.detector)
      ->make(perception.detectors.find(perception.detector),
             {rig, perception.full_stereo, obstacles, history, seed_for(scenario.seed, "detector")});
}

std::unique_ptr<StateSource> state_source_of(const Scenario& scenario, const TruthHistory& history) {
  const std::string& name = scenario.estimation.source;
  return scenario.parts->state_sources.find(name)->make(
      scenario.estimation.sources.find(name),
      {scenario.airframe, history, seed_for(scenario.seed, "state_source")});
}

std::unique_ptr<Planner> planner_of(const Scenario& scenario) {
  const AutopilotConfig& config = scenario.autopilot.autopilot;
  const std::string& name = scenario.autopilot.planning;
  const FlightModel model(scenario.airframe, config.flight_model);
  const Mission mission = scenario.mission();
  return scenario.parts->planners.find(name)->make(
      scenario.autopilot.planners.find(name),
      {config.planner, model, mission, seed_for(scenario.seed, "planner")});
}

AutopilotConfig autopilot_config_of(const Scenario& scenario, const StereoRig& rig) {
  AutopilotConfig config = scenario.autopilot.autopilot;
  config.resightings.depths_m = stated_depths_m(scenario.perception.pushbroom(), rig);
  return config;
}

}  // namespace understory
