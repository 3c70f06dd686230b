#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace understory {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// The aircraft as the estimator believes it to be. Body frame: x forward, y left, z up, at the centre of
/// mass. The world frame is a continuous odometry frame: corrections may move the aircraft, never the points
/// in the map.
struct State {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Zero();  ///< over ground, body axes
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_body_mps2 =
      Eigen::Vector3d::Zero();  ///< newest accelerometer reading, low-passed
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  /// Error covariance, order: attitude (body-frame rotation vector, rad), body velocity, world position, gyro
  /// bias.
  Matrix12d covariance = Matrix12d::Zero();
  double distance_flown_m = 0;  ///< odometer: integral of estimated speed since launch
};

}  // namespace understory
