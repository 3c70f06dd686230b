#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/aircraft.hpp"
#include "sim/cameras/stereo_cameras.hpp"
#include "sim/render/renderer_kind.hpp"
#include "sim/scene/world.hpp"

namespace understory {

/// The simulator's parts as a scenario says them, for whoever moves through its course. All throw in one
/// line.

/// The compiled scene. MachineError where the project's models do not compile.
World world_of(const Scenario& scenario, const std::filesystem::path& models_folder,
               const std::vector<Obstacle>& obstacles);

/// Its cameras, on `rig` of rig_of. MachineError where no GL library can be loaded.
std::unique_ptr<StereoCameras> cameras_of(const Scenario& scenario, const World& world,
                                          const CalibratedRig& rig, RendererKind renderer);

/// Its aircraft on the catapult; `world` must outlive it. ScenarioError where it cannot stand there.
Aircraft aircraft_of(const Scenario& scenario, const World& world);

}  // namespace understory
