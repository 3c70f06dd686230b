#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace understory {

/// The true state. Simulated sensors, scoring and the oracles in scenarios/ read it, the stack never does.
/// Body frame: x forward, y left, z up, at the centre of mass. World: x east, y north, z up.
struct Truth {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< over ground
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_body_mps2 = Eigen::Vector3d::Zero();  ///< acceleration minus gravity
  Eigen::Vector3d wind_world_mps = Eigen::Vector3d::Zero();            ///< where the aircraft is, now
  double left_elevon_rad = 0;  ///< positions of the surfaces, with delay, servo lag and rate limit
  double right_elevon_rad = 0;
  double thrust_n = 0;  ///< of the propeller at this airspeed
};

}  // namespace understory
