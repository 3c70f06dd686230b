#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace understory {

/// Effects of the cameras on the image. All but noise_gray are off by default and then cost neither
/// arithmetic nor random draws. docs/cameras.md measures each effect and its cost.
struct CameraConfig {
  bool lens_cap = false;    ///< black images (proof against self-deception); noise still applies
  double noise_gray = 2.0;  ///< standard deviation of the sensor noise, gray levels, independent per pixel
  double view_distance_m =
      40;  ///< obstacles farther away than this are not drawn (they are a pixel or two wide)

  /// The shutter stands open this long, s, 0 .. 0.02; the image's moment is the middle. Outdoors such
  /// cameras expose for some 0.1 to 5 ms (our assumption); 0: an instant.
  double exposure_s = 0;
  /// Pictures rendered over the exposure and averaged, 1 .. 64: each costs a rendering. Steps between them
  /// show where an edge moves more pixels than there are pictures; at 4 ms nothing the planner cares for
  /// does.
  int exposure_views = 4;
  /// Light gathered by a pixel over what the rendering takes for granted, 0.001 .. 10: less at dusk.
  double light = 1;
  double gain = 1;  ///< of the amplifier after the pixel, 0.1 .. 64: gray levels read over gray levels seen
  /// Electrons in a pixel at gray 255 and gain 1; their number varies by its root (shot noise). 0: no such
  /// noise. Some 10,000 in a 6 um pixel (our assumption). 0 .. 1e6
  double full_well_e = 0;
  /// n of the falloff cos^n of the angle to the optical axis, 0 .. 16: 4 for a plain lens (the cosine-fourth
  /// law), 0 for none.
  double vignetting_power = 0;

  /// The right image stands this much lower than the stack believes, px of the image the camera gives.
  double vertical_misalignment_px = 0;
  /// The right camera's place less what the stack believes, along the right camera's rectified axes (x right,
  /// y down, z forward), m, -0.1 .. 0.1: a bent baseline.
  Eigen::Vector3d flex_position_m = Eigen::Vector3d::Zero();
  /// And its turn about them, rad, -0.1 .. 0.1: a rotation vector.
  Eigen::Vector3d flex_rotation_rad = Eigen::Vector3d::Zero();
  double right_delay_s = 0;  ///< the right image is exposed this much later than the left, s, 0 .. 0.02

  std::int64_t exposure_ns() const { return std::llround(exposure_s * 1e9); }
  std::int64_t right_delay_ns() const { return std::llround(right_delay_s * 1e9); }
  /// From the moment a frame bears, the middle of the left image's exposure, to the end of the right one's.
  std::int64_t exposure_lag_ns() const { return exposure_ns() / 2 + right_delay_ns(); }
};

template <typename Visitor>
void visit_fields(Visitor& visit, CameraConfig& config) {
  visit("lens_cap", config.lens_cap);
  visit("noise_gray", config.noise_gray, 0.0, 50.0);
  visit("view_distance_m", config.view_distance_m, 5.0, 200.0);
  visit("exposure_s", config.exposure_s, 0.0, 0.02);
  visit("exposure_views", config.exposure_views, 1, 64);
  visit("light", config.light, 0.001, 10.0);
  visit("gain", config.gain, 0.1, 64.0);
  visit("full_well_e", config.full_well_e, 0.0, 1e6);
  visit("vignetting_power", config.vignetting_power, 0.0, 16.0);
  visit("vertical_misalignment_px", config.vertical_misalignment_px, -20.0, 20.0);
  visit("flex_position_m", config.flex_position_m, -0.1, 0.1);
  visit("flex_rotation_rad", config.flex_rotation_rad, -0.1, 0.1);
  visit("right_delay_s", config.right_delay_s, 0.0, 0.02);
}

}  // namespace understory
