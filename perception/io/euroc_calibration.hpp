#pragma once

#include <filesystem>
#include <optional>

#include "perception/io/calibration_file.hpp"

namespace understory {

/// The folder with cam0 and cam1 that `path` means: itself or its mav0; empty where neither has them.
std::optional<std::filesystem::path> euroc_folder(const std::filesystem::path& path);

/// A EuRoC/ASL folder's pair of cameras.
struct EurocCalibration {
  StereoCalibration calibration;
  std::optional<double> detection_depth_m;  ///< where the files say it
};

/// Reads cam0/sensor.yaml (left) and cam1/sensor.yaml (right) of a EuRoC/ASL folder: pinhole intrinsics,
/// radial-tangential distortion (EuRoC's 4 numbers, or OpenCV's first 5 or 8), T_BS (sensor coordinates into
/// the body's), resolution; other keys are left alone. Where both files have them, the keys that `understory
/// record` adds (docs/record.md) say how the pair is rectified: `rectification` (raw camera axes into
/// rectified ones, 9 numbers by rows) and `rectified_intrinsics` (focal length, cu, cv in px); otherwise
/// rectify_pair does it. The body stays the files' own: in EuRoC it is the IMU, whose x axis points up and z
/// forward. Errors: see read_calibrated_rig.
EurocCalibration read_euroc_calibration(const std::filesystem::path& folder,
                                        const CalibrationOptions& options);

}  // namespace understory
