#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/perception_config.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// The rig that a scenario names. With raw cameras also their calibration, raw/NAME.xml beside the rig's
/// file, mounted so that the rectified pair has the pose of that file; `rig` is then that pair. Throws
/// ScenarioError in one line where there is no such rig or its files cannot be read.
CalibratedRig rig_of(const Scenario& scenario, const std::filesystem::path& models_folder);

/// The files that rig_of() reads. Throws as it does where there is no such rig.
std::vector<std::filesystem::path> rig_files_of(const Scenario& scenario,
                                                const std::filesystem::path& models_folder);

/// The files that are read for a rig given as a file: that file, and with `raw` its calibration.
std::vector<std::filesystem::path> files_of_rig(const std::filesystem::path& file, bool raw);

/// Throws ScenarioError, one line, if the rule cannot be used with the rig (fault_of). The line names the
/// keys as the user writes them: `depths_key`, and the section of all others.
void check_depths(const PushbroomConfig& rule, const StereoRig& rig, const std::string& depths_key,
                  const std::string& section);

}  // namespace understory
