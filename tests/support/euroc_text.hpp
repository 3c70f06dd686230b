#pragma once

#include <Eigen/Geometry>
#include <sstream>
#include <string>

namespace understory::support {

/// A sensor.yaml in EuRoC's layout, of an invented camera.
inline std::string euroc_sensor_text(const Eigen::Isometry3d& T_body_sensor, double focal_px,
                                     double center_x_px) {
  std::ostringstream text;
  text.precision(17);
  text << "%YAML:1.0\n# made up\nsensor_type: camera\ncomment: none\nT_BS:\n  cols: 4\n  rows: 4\n  data: [";
  for (int i = 0; i < 16; ++i) text << (i > 0 ? ", " : "") << T_body_sensor.matrix()(i / 4, i % 4);
  text << "]\nrate_hz: 20\nresolution: [400, 300]\ncamera_model: pinhole\nintrinsics: [" << focal_px << ", "
       << focal_px + 1 << ", " << center_x_px << ", 148.5] # fu, fv, cu, cv\n"
       << "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0.0002, -0.0001]\n";
  return text.str();
}

/// The left camera looks along body z with its right along -y, as in EuRoC; the right one 0.2 m beside it,
/// turned in by a little.
inline Eigen::Isometry3d euroc_left() {
  Eigen::Isometry3d T_body_left = Eigen::Isometry3d::Identity();
  T_body_left.linear() =
      Eigen::AngleAxisd(1.58, Eigen::Vector3d(0.01, 0.02, 1).normalized()).toRotationMatrix();
  T_body_left.translation() = Eigen::Vector3d(-0.02, -0.06, 0.01);
  return T_body_left;
}
inline Eigen::Isometry3d euroc_right() {
  const Eigen::Isometry3d T_left_right = Eigen::Translation3d(0.2, 0.003, -0.002) *
                                         Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.5, -1, 0.2).normalized());
  return euroc_left() * T_left_right;
}

}  // namespace understory::support
