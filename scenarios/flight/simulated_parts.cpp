#include "scenarios/flight/simulated_parts.hpp"

#include <stdexcept>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/output/file_output.hpp"

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

}  // namespace understory
