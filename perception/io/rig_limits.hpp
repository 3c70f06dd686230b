#pragma once

#include "perception/stereo_rig.hpp"

namespace understory::rig_limits {

/// What every reader asks of a rig, rectified or raw, whatever the file's format: generous around any camera
/// and frame size that flies, narrow enough to catch a wrong unit.
inline constexpr int minimum_size_px = 32, maximum_size_px = 8192;
inline constexpr double minimum_focal_px = 10, maximum_focal_px = 20000;
inline constexpr double minimum_baseline_m = 0.01, maximum_baseline_m = 10;
inline constexpr double minimum_center_px = -8192, maximum_center_px = 16384;
inline constexpr double minimum_depth_m = 0.1, maximum_depth_m = 1000;
inline constexpr double maximum_offset_m = 10;  ///< of a camera from the body's origin

/// Whether a detector can look at the rig's detection depth: its nearest whole disparity lies more than a
/// pixel nearer than infinity, and leaves at least a tenth of the image's columns (and a 5x5 block) to
/// compare.
bool detection_depth_in_view(const StereoRig& rig);

}  // namespace understory::rig_limits
