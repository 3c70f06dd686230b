#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "estimation/state_source.hpp"
#include "perception/io/calibration_file.hpp"
#include "perception/obstacle_detector.hpp"
#include "planning/autopilot.hpp"
#include "scenarios/flight/oracles/truth_history.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/aircraft.hpp"
#include "sim/cameras/stereo_cameras.hpp"
#include "sim/render/renderer_kind.hpp"
#include "sim/scene/world.hpp"

namespace understory {

// Makes the parts of a flight from a scenario. All throw in one line.

/// The compiled scene. MachineError where the project's models do not compile.
World world_of(const Scenario& scenario, const std::filesystem::path& models_folder,
               const std::vector<Obstacle>& obstacles);

/// Its cameras, on `rig` of rig_of. MachineError where no GL library can be loaded.
std::unique_ptr<StereoCameras> cameras_of(const Scenario& scenario, const World& world,
                                          const CalibratedRig& rig, RendererKind renderer);

/// Its aircraft on the catapult; `world` must outlive it. ScenarioError where the catapult would begin
/// underground.
Aircraft aircraft_of(const Scenario& scenario, const World& world);

/// What turns pairs into hits. ScenarioError where the rig cannot look at the depths asked for. An oracle
/// keeps a reference to the history.
std::unique_ptr<ObstacleDetector> detector_of(const Scenario& scenario, const CalibratedRig& rig,
                                              const std::vector<Obstacle>& obstacles,
                                              const TruthHistory& history);

/// The autopilot's source of state. An oracle keeps a reference to the history.
std::unique_ptr<StateSource> state_source_of(const Scenario& scenario, const TruthHistory& history);

AutopilotConfig autopilot_config_of(const Scenario& scenario);

}  // namespace understory
