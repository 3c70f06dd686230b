#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace understory {

/// The filter's error states: twelve of motion and gyro, then the barometer's offset and eight of which each
/// kind is a switch (its rows and columns are exactly zero where it is off). First row of each block, in the
/// order of State::covariance.
enum ErrorBlock {
  attitude_block = 0,             ///< body-frame rotation vector, rad
  velocity_block = 3,             ///< over ground, body axes, m/s
  position_block = 6,             ///< world axes, m
  rate_block = 9,                 ///< gyro bias, rad/s (the paper's model: angular rate)
  accelerometer_bias_block = 12,  ///< m/s^2
  wind_block = 15,                ///< world x and y, m/s: what lasts
  gust_block = 17,                ///< world x and y, m/s: what passes within some tens of metres
  pitot_bias_block = 19,          ///< m/s
  barometer_offset_block = 20,    ///< m
  error_states = 21
};

using ErrorVector = Eigen::Matrix<double, error_states, 1>;
using ErrorCovariance = Eigen::Matrix<double, error_states, error_states>;

/// The aircraft as the estimator believes it to be. Body frame: x forward, y left, z up, at the centre of
/// mass. The world frame is a continuous odometry frame: in flight no correction moves the position in it or
/// turns it about the vertical, so that what was seen stays where it was seen.
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
  double barometer_offset_m = 0;  ///< what the barometer reads too much
  double altitude_m = 0;  ///< above the launch point's ground: the odometry's z with its drift taken out
  ErrorCovariance covariance = ErrorCovariance::Zero();  ///< order of ErrorBlock
  /// Dead reckoning by inertial sensors alone, world axes: its increments compare what a late measurement
  /// says of an earlier moment with the estimate of now. Its own value drifts freely.
  Eigen::Vector3d inertial_velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d inertial_position_world_m = Eigen::Vector3d::Zero();
  double distance_flown_m = 0;  ///< odometer: integral of estimated speed since launch
};

}  // namespace understory
