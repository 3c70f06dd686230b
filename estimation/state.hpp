#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace understory {

/// First row of each block of the filter's error states, in the order of State::covariance: twelve of motion
/// and gyro, the barometer's offset, and nine that can be switched off by kind. Rows and columns of a kind
/// that is off are exactly zero.
enum ErrorBlock {
  attitude_block = 0,             ///< body-frame rotation vector, rad
  velocity_block = 3,             ///< over ground, body axes, m/s
  position_block = 6,             ///< world axes, m
  rate_block = 9,                 ///< gyro bias, rad/s (the paper's model: angular rate)
  accelerometer_bias_block = 12,  ///< m/s^2
  wind_block = 15,                ///< world x and y, m/s: the steady part
  gust_block = 17,                ///< world x and y, m/s: the part that changes within some tens of metres
  pitot_bias_block = 19,          ///< m/s
  barometer_offset_block = 20,    ///< m
  barometer_wash_block = 21,      ///< m per N of thrust
  error_states = 22
};

using ErrorVector = Eigen::Matrix<double, error_states, 1>;
using ErrorCovariance = Eigen::Matrix<double, error_states, error_states>;

/// The aircraft as the estimator believes it to be. Body frame: x forward, y left, z up, at the centre of
/// mass. The world frame is a continuous odometry frame. In flight no correction moves the position in it or
/// turns it about the vertical, so that obstacles stay where they were seen.
struct State {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Zero();  ///< over ground, body axes
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_body_mps2 =
      Eigen::Vector3d::Zero();  ///< newest accelerometer reading, low-passed
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector2d wind_world_mps = Eigen::Vector2d::Zero();  ///< the air's velocity, the gust not included
  Eigen::Vector2d gust_world_mps = Eigen::Vector2d::Zero();
  double pitot_bias_mps = 0;
  double barometer_offset_m = 0;      ///< the barometer reads too high by this
  double barometer_wash_m_per_n = 0;  ///< and by this for each newton of thrust
  double altitude_m = 0;  ///< above the launch point's ground: the odometry's z with its drift taken out
  ErrorCovariance covariance = ErrorCovariance::Zero();  ///< order of ErrorBlock
  /// Dead reckoning by inertial sensors alone, world axes. Its increments relate a late measurement of an
  /// earlier moment to the present estimate. Its value drifts freely.
  Eigen::Vector3d inertial_velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d inertial_position_world_m = Eigen::Vector3d::Zero();
  double distance_flown_m = 0;  ///< odometer: integral of estimated speed since launch
};

}  // namespace understory
