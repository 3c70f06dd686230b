#pragma once

#include <filesystem>

#include "perception/io/calibration_file.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// The rig that a scenario names. With raw cameras also their calibration, raw/NAME.xml beside the rig's
/// file, mounted so that the rectified pair has the pose of that file; `rig` is then that pair. Throws
/// ScenarioError in one line where there is no such rig or its files cannot be read.
CalibratedRig rig_of(const Scenario& scenario, const std::filesystem::path& models_folder);

}  // namespace understory
