#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace understory {

class FieldVisitor;

/// Effects of the cameras on the image. All but noise_gray are off by default and then cost neither
/// arithmetic nor random draws. docs/cameras.md measures each effect and its cost.
struct CameraConfig {
  bool lens_cap = false;
  double noise_gray = 2.0;
  double view_distance_m = 40;

  double exposure_s = 0;
  int exposure_views = 4;
  double rolling_shutter_s = 0;
  int rolling_shutter_views = 8;
  double auto_exposure_s = 0;
  double auto_exposure_gray = 110;
  double light = 1;
  double gain = 1;
  double full_well_e = 0;
  double vignetting_power = 0;
  double psf_px = 0;
  int supersampling = 1;
  bool bayer = false;

  double vertical_misalignment_px = 0;
  Eigen::Vector3d flex_position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d flex_rotation_rad = Eigen::Vector3d::Zero();
  double right_delay_s = 0;

  std::int64_t exposure_ns() const { return std::llround(exposure_s * 1e9); }
  std::int64_t right_delay_ns() const { return std::llround(right_delay_s * 1e9); }
  /// From the first row's exposure to the last row's.
  std::int64_t readout_ns() const { return std::llround(rolling_shutter_s * 1e9); }
  /// From a frame's time, the middle of the exposure of the left image's middle row, to the end of the
  /// exposure of the right image's last row.
  std::int64_t exposure_lag_ns() const { return exposure_ns() / 2 + readout_ns() / 2 + right_delay_ns(); }
};

void visit_fields(FieldVisitor& visit, CameraConfig& config);

}  // namespace understory
