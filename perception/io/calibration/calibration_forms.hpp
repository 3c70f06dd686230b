#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core/matx.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/image_file.hpp"
#include "perception/io/strict_map.hpp"

/// What the readers of the several formats share, and the readers themselves (read_calibrated_rig chooses).
namespace understory {

/// The limits that every reader applies to a rig, rectified or raw, in any file format: wide enough for any
/// camera and frame size that flies, narrow enough to catch a wrong unit.
namespace rig_limits {
inline constexpr int minimum_size_px = 32, maximum_size_px = maximum_side_px;
inline constexpr double minimum_focal_px = 10, maximum_focal_px = 20000;
inline constexpr double minimum_baseline_m = 0.01, maximum_baseline_m = 10;
inline constexpr double minimum_center_px = -8192, maximum_center_px = 16384;
inline constexpr double minimum_depth_m = 0.1, maximum_depth_m = 1000;
inline constexpr double maximum_coefficient = 1e4;  ///< of a lens: wild ones reach 13 (the paper's rig)
inline constexpr double maximum_offset_m = 10;      ///< of a camera from the body's origin
inline constexpr double maximum_entry = 1e9;  ///< of a matrix: focal lengths times millimetres stay far below
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

/// A raw camera as a file states it.
struct RawCamera {
  StrictMap map;  ///< the file, or the camera's part of it
  CameraCalibration calibration;
  ImageSize size;
};

/// The left camera is at the body's origin and looks along its x axis, as of forms that define no body.
/// `size_key`: of the size, which must be the same, as the lens must. Throws InputError.
StereoCalibration raw_pair(const RawCamera& left, const RawCamera& right, const std::string& file,
                           const std::string& size_key, const CalibrationOptions& options);

/// Throws InputError where K is not fx 0 cx, 0 fy cy, 0 0 1 within the limits.
void require_camera_matrix(StrictMap& map, const std::string& key, const cv::Matx33d& K);
/// Throws InputError where P is not f 0 cx t, 0 f cy 0, 0 0 1 0: of rectified cameras side by side.
void require_projection(StrictMap& map, const std::string& key, const cv::Matx34d& P);
/// Throws InputError where R is not right-handed and orthonormal to 0.001, since files are rounded by hand.
void require_rotation(StrictMap& map, const std::string& key, const cv::Matx33d& R);

/// fu, fv, cu, cv in px.
cv::Matx33d pinhole_matrix(StrictMap& map, const std::string& key);

/// Width and height in px.
ImageSize resolution(StrictMap& map, const std::string& key);

/// What a form calls a lens.
struct LensWord {
  std::string_view word;
  LensModel lens;
};

/// Throws InputError, naming the words, where the value is none of them.
LensModel lens_model(StrictMap& map, const std::string& key, std::span<const LensWord> words);

/// Throws InputError where the value is another.
void require_text(StrictMap& map, const std::string& key, const std::string& expected);

/// Throws InputError where the user says a unit, and the form is in metres by its documentation.
void require_metres(const std::string& file, const std::string& form, const CalibrationOptions& options);

/// The content of a calibration file, unpacked where it is gzip's (OpenCV writes .xml.gz). Throws as
/// read_file does.
std::string calibration_text(const std::filesystem::path& file);

/// Fills both cameras' `rectification` and `projection` with cv::stereoRectify's (CALIB_ZERO_DISPARITY, alpha
/// 0: principal points alike, every rectified pixel seen by the raw image). Camera matrices, distortion and
/// size must be set. A point x in left camera coordinates is R_right_left * x + t_right in right ones, as
/// `map` says under `key`. Throws InputError where no rectified pair results. A pair without distortion that
/// is aligned already stays as it is.
void rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left, const cv::Vec3d& t_right_m,
                  const StrictMap& map, const std::string& key);

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

/// Whether `text` is XML, or OpenCV's kind of YAML or JSON (else it may be a rig file).
bool looks_like_opencv(const std::string& text);

/// Reads the raw pair cam0 (left) and cam1 (right) from a camchain as Kalibr writes it: pinhole cameras with
/// radtan or equidistant lenses, resolution, T_cn_cnm1 in metres (rectified here). It defines no body: see
/// read_opencv_calibration.
StereoCalibration read_kalibr_calibration(const std::filesystem::path& file,
                                          const CalibrationOptions& options);

/// Reads the raw pair from two files of ROS's camera_info, in any order: camera_matrix, distortion_model
/// (plumb_bob, rational_polynomial or equidistant), rectification_matrix and projection_matrix, whose (0, 3)
/// tells the right camera and the baseline. The same body.
StereoCalibration read_ros_calibration(const std::array<std::filesystem::path, 2>& files,
                                       const CalibrationOptions& options);

/// Reads the rectified gray pair, or the colour pair where there is no gray one, from KITTI's calib.txt (P0:
/// P1:) or calib_cam_to_cam.txt (P_rect_00: P_rect_01:, S_rect_00: its size). In metres. The same body.
StereoCalibration read_kitti_calibration(const std::filesystem::path& file,
                                         const CalibrationOptions& options);

/// Reads the rectified pair from Middlebury's calib.txt (cam0=[...], cam1=[...], doffs, baseline in mm,
/// width, height), which ETH3D has, too. The same body.
StereoCalibration read_middlebury_calibration(const std::filesystem::path& file,
                                              const CalibrationOptions& options);

}  // namespace understory
