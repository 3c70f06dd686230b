#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace understory {

struct DepthInterval {
  double near_m = 0;
  double far_m = 0;
};

/// A rectified stereo rig: two pinhole cameras with parallel axes, rows aligned.
///
/// Pixel coordinates: centre of the top left pixel is (0, 0), u to the right, v down. Camera frame: OpenCV
/// axes (x right, y down, z forward) at the LEFT camera's optical centre; the right camera sits at x =
/// +baseline_m. A point at depth z (distance along the optical axis) appears at
///   u_left  = focal_px * x / z + center_left_x_px,   u_right = focal_px * (x - baseline_m) / z +
///   center_right_x_px,
/// so u_left - u_right = focal_px * baseline_m / z + infinity_disparity_px(). Calibrations in the field leave
/// the two principal points apart (the paper's rig: 197.5 and 105.7), so "infinity" is far from zero; it is
/// derived here (PushbroomConfig::infinity_px states another by hand).
struct StereoRig {
  std::string name;
  int width_px = 376;
  int height_px = 240;
  double focal_px = 0;
  double baseline_m = 0;
  double center_left_x_px = 0;
  double center_right_x_px = 0;
  double center_y_px = 0;
  double detection_depth_m =
      0;  ///< the requested detection depth; the detector uses the nearest whole disparity
  Eigen::Isometry3d T_body_camera =
      Eigen::Isometry3d::Identity();  ///< camera coordinates into body coordinates

  double infinity_disparity_px() const { return center_left_x_px - center_right_x_px; }
  double disparity_px(double depth_m) const {
    return focal_px * baseline_m / depth_m + infinity_disparity_px();
  }
  double depth_m(double disparity_px) const {
    return focal_px * baseline_m / (disparity_px - infinity_disparity_px());
  }
  /// Depths whose disparity lies `pixels` or less from this one; far_m is infinite where that reaches
  /// infinity.
  DepthInterval depths_around(double disparity_px, double pixels = 1) const {
    const double farther_px = disparity_px - pixels;
    return {depth_m(disparity_px + pixels), farther_px > infinity_disparity_px()
                                                ? depth_m(farther_px)
                                                : std::numeric_limits<double>::infinity()};
  }
  /// Whether a detector can compare the images at this whole disparity: it lies more than a pixel nearer than
  /// infinity, and leaves at least a tenth of the images' columns (and a 5x5 block).
  bool can_look_at(double whole_disparity_px) const {
    return whole_disparity_px - infinity_disparity_px() > 1.0 &&
           std::abs(whole_disparity_px) <= std::min(0.9 * width_px, 1.0 * width_px - 5);
  }
  /// The row as far down these images as `row_of_240` is down the paper's, which have 240 rows.
  int scaled_row_px(int row_of_240) const {
    return static_cast<int>(std::lround(row_of_240 * height_px / 240.0));
  }
};

}  // namespace understory
