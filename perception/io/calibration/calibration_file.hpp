#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>

#include "perception/stereo_calibration.hpp"

namespace understory {

/// Values that some calibration formats do not contain.
struct CalibrationOptions {
  /// Of the file's translations: 0.01 if they are in centimetres. If nothing is said they are in metres, and
  /// of forms that state no unit a baseline is refused that is hardly one in metres.
  std::optional<double> meters_per_unit{};
  std::optional<int> width_px{}, height_px{};  ///< of the images, both, if the files do not state it
  std::optional<double> detection_depth_m{};   ///< overrides the rig file's own; 10 m if neither is given
  bool of_colour_pair = false;                 ///< of KITTI's two pairs, which stand in one file
  std::optional<cv::Size> images_at_hand{};    ///< size of the images, if neither files nor options state it
};

/// Reads a rig from any form that calibration_forms.hpp reads, or from a rig file (read_rig). The form is
/// told from the contents. A folder is EuRoC's (mav0, or the one above it), holds OpenCV's matrices or ROS's
/// two files, or one file of another form. The rig is named after its file or folder. The pose in the body: a
/// rig file's own mounting; EuRoC's T_BS, whose body is the file's own (the IMU, x up); other forms define no
/// body, so the raw left camera is at its origin and looks along its x axis. The returned rig fits a detector
/// (the detection depth's disparity lies in the images) and a Rectifier; where rectifying would change
/// nothing, it has no calibration. Throws InputError, one line "file[:line]: key: what was expected", if
/// anything is missing, of a wrong type, not finite or out of range, if the images' size is needed and
/// unknown or contradictory, and if no rectified pair results. No content of a file causes another exception.
CalibratedRig read_calibrated_rig(const std::filesystem::path& path, const CalibrationOptions& options);

/// Reads a rig from YAML. These keys are required, and no others are allowed: name, width_px, height_px,
/// focal_px, baseline_m, center_left_x_px, center_right_x_px, center_y_px, detection_depth_m,
/// left_camera_body_m (x forward, y left, z up of the centre of mass), pitch_down_deg (of both cameras
/// against body x); but yaw_left_deg and roll_right_deg may be left out (0). Throws InputError "file:line:
/// key: what was expected" at an unknown, doubled, missing, mistyped or out-of-range key, at broken YAML, and
/// at a file that cannot be read.
StereoRig read_rig(const std::filesystem::path& file);

/// The camera's pose for a mounting: OpenCV axes, looking along body x; rolled to the right about body x,
/// then pitched down, then yawed to the left about body z.
Eigen::Isometry3d T_body_camera_of(const Eigen::Vector3d& left_camera_body_m, double pitch_down_rad,
                                   double yaw_left_rad = 0, double roll_right_rad = 0);

/// raw/NAME.xml beside a rig file NAME.yaml: the OpenCV calibration of the raw cameras behind it.
std::filesystem::path raw_file_of(const std::filesystem::path& rig_file);

}  // namespace understory
