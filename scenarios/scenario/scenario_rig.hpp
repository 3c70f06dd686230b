#pragma once

#include <filesystem>

#include "perception/io/calibration_file.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// The rig that a scenario names. Where its cameras come raw, also their calibration: raw/NAME.xml beside the
/// rig's file, mounted so that the rectified pair stands and looks as that file says; `rig` is then that
/// pair. Throws ScenarioError in one line where there is no such rig or its files cannot be read.
CalibratedRig rig_of(const Scenario& scenario, const std::filesystem::path& models_folder);

}  // namespace understory
