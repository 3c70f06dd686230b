#pragma once

#include <filesystem>
#include <optional>

#include "perception/io/calibration_file.hpp"

namespace understory {

/// The folder with cam0 and cam1 that `path` means: itself or its mav0; empty where neither has them.
std::optional<std::filesystem::path> euroc_folder(const std::filesystem::path& path);

/// Reads a EuRoC/ASL folder's cam0/sensor.yaml (left) and cam1/sensor.yaml (right): pinhole intrinsics,
/// radial-tangential distortion, T_BS (sensor coordinates into the body's), resolution; other keys are left
/// alone. Rectifies with rectify_pair. The body stays the files' own: in EuRoC it is the IMU, whose x axis
/// points up and z forward. Errors: see read_calibrated_rig.
StereoCalibration read_euroc_calibration(const std::filesystem::path& folder,
                                         const CalibrationOptions& options);

}  // namespace understory
