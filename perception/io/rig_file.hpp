#pragma once

#include <filesystem>

#include "perception/stereo_rig.hpp"

namespace understory {

/// Reads a rig from YAML. Every key is required and known: name, width_px, height_px, focal_px, baseline_m,
/// center_left_x_px, center_right_x_px, center_y_px, detection_depth_m, left_camera_body_m (x forward, y
/// left, z up of the centre of mass), pitch_down_deg (of both cameras against body x). Throws
/// std::runtime_error "file:line: key: what was expected" at an unknown, doubled, missing, mistyped or
/// out-of-range key, at broken YAML, and at a file that cannot be read.
StereoRig read_rig(const std::filesystem::path& file);

/// The camera's pose for a mounting: OpenCV axes, looking along body x turned down by pitch_down_rad.
Eigen::Isometry3d T_body_camera_of(const Eigen::Vector3d& left_camera_body_m, double pitch_down_rad);

}  // namespace understory
