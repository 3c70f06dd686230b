#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "perception/stereo_calibration.hpp"

namespace understory {

enum class CalibrationForm { rig_file, opencv, kalibr, ros };

/// The raw cameras; of a pair whose images come rectified, cameras such that rectifying changes nothing.
StereoCalibration cameras_of(const CalibratedRig& calibrated);

struct CalibrationText {
  std::filesystem::path file;
  std::string text;
};

/// The calibration in a form that read_calibrated_rig reads, in metres, every number exact:
/// - rig_file (`out`.yaml): the rectified pair and its mounting; raw cameras go to raw/`out`.xml beside it,
///   where a scenario with cameras.raw looks for them;
/// - opencv (`out`.xml, .yaml, .yml, .json): M1 D1 M2 D2 R T R1 R2 P1 P2 and the size; no mounting;
/// - kalibr (`out`.yaml): a camchain; no mounting. It says nothing of the rectified pair: who reads it
///   rectifies anew;
/// - ros (a folder `out`): left.yaml and right.yaml; no mounting.
/// Throws InputError where `out` ends in something else, and where Kalibr's four coefficients cannot say the
/// lens.
std::vector<CalibrationText> calibration_texts(const CalibratedRig& calibrated, CalibrationForm form,
                                               const std::filesystem::path& out);

/// "1, 2, 3", each number in the fewest digits that read back exactly.
std::string list_text(std::span<const double> values);

}  // namespace understory
