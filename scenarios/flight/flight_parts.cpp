#include "scenarios/flight/flight.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "estimation/filter.hpp"
#include "perception/full_stereo/full_stereo.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/config_writer.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/oracles.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

template <typename MatcherConfig>
std::unique_ptr<ObstacleDetector> full_stereo_of(const CalibratedRig& cameras, const MatcherConfig& matcher,
                                                 const FullStereoCrop& crop) {
  auto detector = std::make_unique<FullStereoDetector>(cameras.rig, matcher, crop);
  if (!cameras.calibration) return detector;
  return std::make_unique<RectifyingDetector>(*cameras.calibration, std::move(detector));
}

}  // namespace

World world_of(const Scenario& scenario, const std::filesystem::path& models_folder) {
  const Wood wood = course_wood(scenario);
  try {
    WorldConfig config = scenario.world_config();
    config.woods = woods_of(scenario);
    return build_world(models_folder, scenario.flown_airframe(), wood.obstacles, config, wood.trees);
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
    return std::make_unique<StereoCameras>(world, rig.rig, scenario.cameras.cameras, seeds, rig.calibration,
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
    return Aircraft(*world.model, scenario.flown_airframe(), scenario.launch, wind, scenario.actuators,
                    scenario.forest.intangible ? std::vector<Obstacle>{} : world.obstacles);
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

std::unique_ptr<ObstacleDetector> detector_of(const Scenario& scenario, const CalibratedRig& rig,
                                              const std::vector<Obstacle>& obstacles,
                                              const TruthHistory& history) {
  const PerceptionSection& perception = scenario.perception;
  switch (perception.detector) {
    case DetectorKind::pushbroom:
      check_depths(perception.pushbroom, rig.rig, "perception.depths_m", "perception.pushbroom");
      return std::make_unique<PushbroomStereo>(rig, perception.pushbroom);
    case DetectorKind::stereo_bm:
      return full_stereo_of(rig, perception.stereo_bm, perception.full_stereo);
    case DetectorKind::stereo_sgbm:
      return full_stereo_of(rig, perception.stereo_sgbm, perception.full_stereo);
    case DetectorKind::true_depth:
      return std::make_unique<TrueDepth>(rig.rig, obstacles, history);
    case DetectorKind::none:
      break;
  }
  return std::make_unique<NoDetector>();
}

std::unique_ptr<StateSource> state_source_of(const Scenario& scenario, const TruthHistory& history) {
  if (scenario.estimation.source == StateKind::truth) return std::make_unique<TrueState>(history);
  return std::make_unique<Filter>(scenario.estimation.filter);
}

AutopilotConfig autopilot_config_of(const Scenario& scenario, const StereoRig& rig) {
  AutopilotConfig config = scenario.autopilot.autopilot;
  config.resightings.depths_m = stated_depths_m(scenario.perception.pushbroom, rig);
  return config;
}

}  // namespace understory
