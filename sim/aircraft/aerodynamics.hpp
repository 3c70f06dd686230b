#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/airframe.hpp"

namespace understory {

/// Converts between the flight records' axes (x forward, y right, z down) and our body axes (x forward, y
/// left, z up): half a turn about x, which is its own inverse. Valid for velocities, rates, forces and
/// moments.
inline Eigen::Vector3d flip_yz(const Eigen::Vector3d& vector) {
  return {vector.x(), -vector.y(), -vector.z()};
}

/// Force and moment on the body, at its centre of mass, body axes.
struct Wrench {
  Eigen::Vector3d force_body_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_body_nm = Eigen::Vector3d::Zero();
};

/// The aircraft's motion through the air and the positions of its controls.
struct AirState {
  Eigen::Vector3d air_velocity_body_mps = Eigen::Vector3d::Zero();  ///< of the body relative to the air
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  double left_elevon_rad = 0;  ///< positive trailing edge up
  double right_elevon_rad = 0;
  double thrust_n = 0;
  double motor_torque_nm = 0;  ///< on the propeller, positive turning clockwise seen from behind
  double elevon_wash_mps = 0;  ///< speed that the propeller adds along body x at the elevons
};

/// The identified flat-plate model (flight records of the original aircraft, 2014 to 2017): wing, two
/// elevons, two winglets, body drag, rate damping, thrust and the motor's reaction. CL = 2 sin a cos a, CD =
/// 2 sin^2 a: it never stalls, so callers must limit the angle of attack to 25 to 30 deg. Without gravity.
/// Limits of elevons and thrust are the caller's task.
Wrench aerodynamic_wrench(const Airframe& airframe, const AirState& air);

/// Angle between the chord and the oncoming air, rad, positive nose above the path.
double angle_of_attack_rad(const Eigen::Vector3d& air_velocity_body_mps);

/// Angle of the oncoming air to the plane of symmetry, rad, positive drifting left.
double sideslip_rad(const Eigen::Vector3d& air_velocity_body_mps);

/// Straight steady flight with the wings level.
struct Trim {
  double airspeed_mps = 0;
  double climb_angle_rad = 0;
  double angle_of_attack_rad = 0;
  double elevon_rad = 0;  ///< both, positive trailing edge up
  double thrust_n = 0;
};

/// Newton's method on the three longitudinal equations of the flat-plate model. Empty where the airframe
/// cannot fly like this: thrust or elevons beyond their limits, or an angle of attack above
/// `max_angle_of_attack_rad` (flat plates never stall, real wings do at 25 to 30 deg).
std::optional<Trim> straight_trim(const Airframe& airframe, double airspeed_mps, double climb_angle_rad = 0,
                                  double max_angle_of_attack_rad = 0.5236);

/// Angle of attack at which the catapult holds and releases the aircraft: that of level flight at the release
/// speed, even if the motor could not hold that speed.
double release_angle_of_attack_rad(const Airframe& airframe, double speed_mps);

}  // namespace understory
