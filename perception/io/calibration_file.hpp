#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>

#include "perception/stereo_calibration.hpp"

namespace understory {

/// What some calibration formats do not say themselves.
struct CalibrationOptions {
  double meters_per_unit = 1;  ///< of the file's translations: 0.01 where they are in centimetres
  std::optional<int> width_px{}, height_px{};  ///< of the images, both, where the files do not tell
  std::optional<double> detection_depth_m{};   ///< goes before the rig file's own; 10 m where nobody says
  std::optional<cv::Size> images_at_hand{};    ///< their size is taken where neither files nor options tell
};

/// Reads a rig from any of
/// - our own rig file (YAML, read_rig),
/// - one OpenCV XML or YAML file with M1 D1 M2 D2 and either R1 R2 P1 P2 or R T (then rectified here with
///   cv::stereoRectify, alpha 0), names as OpenCV's stereo_calib sample writes them; image_width and
///   image_height where they are,
/// - a folder of such files: one matrix each (M1.xml, D1.xml, R1.xml, P1.xml, M2.xml ...), or intrinsics.yml
///   and extrinsics.yml,
/// - a EuRoC/ASL folder (mav0, or the folder above it): cam0/sensor.yaml (left) and cam1/sensor.yaml (right);
///   the detection depth where cam0's says one (read_euroc_calibration).
/// The rig is named after its file or folder. The pose in the body: a rig file's own mounting; EuRoC's T_BS,
/// whose body is the file's own (the IMU, x up); OpenCV's files know no body, so the raw left camera sits at
/// its origin and looks along its x axis. What is returned fits a detector (the detection depth's disparity
/// lies in the images) and a Rectifier. Throws InputError, one line "file[:line]: key: what was
/// expected", at anything missing, mistyped, not finite or out of range, where images' size is needed and
/// nobody says it or two say different ones, and where no rectified pair comes out: no bytes end in anything
/// else.
CalibratedRig read_calibrated_rig(const std::filesystem::path& path, const CalibrationOptions& options);

/// Reads a rig from YAML. Every key is required and known: name, width_px, height_px, focal_px, baseline_m,
/// center_left_x_px, center_right_x_px, center_y_px, detection_depth_m, left_camera_body_m (x forward, y
/// left, z up of the centre of mass), pitch_down_deg (of both cameras against body x). Throws
/// InputError "file:line: key: what was expected" at an unknown, doubled, missing, mistyped or
/// out-of-range key, at broken YAML, and at a file that cannot be read.
StereoRig read_rig(const std::filesystem::path& file);

/// The camera's pose for a mounting: OpenCV axes, looking along body x turned down by pitch_down_rad.
Eigen::Isometry3d T_body_camera_of(const Eigen::Vector3d& left_camera_body_m, double pitch_down_rad);

/// The folder with cam0 and cam1 that `path` means: itself or its mav0; empty where neither has them.
std::optional<std::filesystem::path> euroc_folder(const std::filesystem::path& path);

}  // namespace understory
