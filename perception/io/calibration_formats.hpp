#pragma once

#include <opencv2/core/matx.hpp>
#include <optional>
#include <string>

#include "perception/io/calibration_file.hpp"

/// What the readers of the several formats share, and the readers themselves (read_calibrated_rig chooses).
namespace understory {

/// The limits that every reader applies to a rig, rectified or raw, in any file format: wide enough for any
/// camera and frame size that flies, narrow enough to catch a wrong unit.
namespace rig_limits {
inline constexpr int minimum_size_px = 32, maximum_size_px = 8192;
inline constexpr double minimum_focal_px = 10, maximum_focal_px = 20000;
inline constexpr double minimum_baseline_m = 0.01, maximum_baseline_m = 10;
inline constexpr double minimum_center_px = -8192, maximum_center_px = 16384;
inline constexpr double minimum_depth_m = 0.1, maximum_depth_m = 1000;
inline constexpr double maximum_offset_m = 10;  ///< of a camera from the body's origin
}  // namespace rig_limits

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  bool operator==(const ImageSize&) const = default;
};

/// The size that the file states, else the options' size, else that of the images at hand. Throws InputError
/// if none is known, if file and options differ, or if the options' size is invalid.
ImageSize agreed_image_size(const std::string& file, std::optional<ImageSize> of_file,
                            const CalibrationOptions& options);

/// Orthonormal to 0.001, since files are rounded by hand, and right-handed.
bool is_rotation(const cv::Matx33d& matrix);

/// Fills both cameras' `rectification` and `projection` with cv::stereoRectify's (CALIB_ZERO_DISPARITY, alpha
/// 0: principal points alike, every rectified pixel seen by the raw image). Camera matrices, distortion and
/// size must be set. A point x in left camera coordinates is R_right_left * x + t_right in right ones. False
/// if no rectified pair results.
bool rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left,
                  const cv::Vec3d& t_right_m);

/// A EuRoC/ASL folder's pair of cameras.
struct EurocCalibration {
  StereoCalibration calibration;
  std::optional<double> detection_depth_m;  ///< if the files have one
};

/// Reads cam0/sensor.yaml (left) and cam1/sensor.yaml (right) of a EuRoC/ASL folder: pinhole intrinsics,
/// radial-tangential distortion (EuRoC's 4 numbers, or OpenCV's first 5 or 8), T_BS (sensor coordinates into
/// the body's), resolution; other keys are ignored. If both files have them, the keys that `understory
/// record` adds (docs/record.md) say how the pair is rectified: `rectification` (raw camera axes into
/// rectified ones, 9 numbers by rows) and `rectified_intrinsics` (focal length, cu, cv in px); otherwise
/// rectify_pair does it. The body stays the files' own: in EuRoC it is the IMU, whose x axis points up and z
/// forward. Errors: see read_calibrated_rig.
EurocCalibration read_euroc_calibration(const std::filesystem::path& folder,
                                        const CalibrationOptions& options);

/// Reads the raw pair from one OpenCV XML or YAML file, or from a folder of them: one matrix a file, named as
/// the matrix (M1.xml), or intrinsics.yml and extrinsics.yml as OpenCV's stereo_calib sample writes them.
/// It reads M1 D1 M2 D2 and either R1 R2 P1 P2 or R T (then rectified here), and image_width, image_height if
/// present; other keys are ignored. The files define no body: the left camera is put at its origin, looking
/// along body x. Errors: see read_calibrated_rig.
StereoCalibration read_opencv_calibration(const std::filesystem::path& path,
                                          const CalibrationOptions& options);

/// Whether `text` is XML or OpenCV's kind of YAML (else it may be a rig file).
bool looks_like_opencv(const std::string& text);

}  // namespace understory
