#pragma once

#include <Eigen/Geometry>

#include "planning/airframe.hpp"
#include "sim/aircraft/aircraft.hpp"

namespace understory {

/// How a flight begins in the air.
struct AirborneStart {
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Controls controls;  ///< and all that is still on its way to the surfaces
};

/// Straight and level at this speed. Throws std::logic_error where the airframe cannot fly so.
AirborneStart trimmed_start(const Airframe& airframe, double airspeed_mps);

constexpr double start_altitude_m = 500;  ///< nothing is met on the way down

/// An empty world of still air, for flights that begin `start_altitude_m` above the origin and meet nothing.
class FreeFlight {
 public:
  /// Mass and inertia of every flight are `airframe`'s.
  explicit FreeFlight(const Airframe& airframe);

  /// The simulator's own aircraft, its aerodynamics those of `airframe`. Must not outlive this.
  Aircraft begin(const Airframe& airframe, const AirborneStart& start) const;

 private:
  World world_;
};

}  // namespace understory
