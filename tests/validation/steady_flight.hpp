#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/airframe.hpp"

namespace understory {

/// Flight in which nothing turns faster or slower: straight, or in a circle, climbing or sinking along a
/// helix; and, as if frozen at one moment, gaining or losing speed along the path.
struct SteadyFlight {
  double airspeed_mps = 0;
  double bank_rad = 0;         ///< of the lift about the velocity, right wing down positive
  double climb_angle_rad = 0;  ///< of the velocity
  double thrust_n = 0;
  double acceleration_mps2 = 0;  ///< along the path
  double angle_of_attack_rad = 0;
  double sideslip_rad = 0;
  double left_elevon_rad = 0;
  double right_elevon_rad = 0;
  double turn_rate_radps = 0;  ///< of the heading, to the right positive
  double load_factor = 0;      ///< lift of wings and thrust over the weight

  double radius_m() const;
  double sink_mps() const;
};

enum class Solved { thrust, acceleration, climb_angle };

/// Newton's method on all six equations of the flat-plate aircraft, from `given`'s airspeed, bank, and those
/// two of thrust, acceleration and climb angle that are not `solved` for. Elevons and thrust may come out
/// beyond their limits; empty where the angle of attack passes `max_angle_of_attack_rad` or nothing is found.
std::optional<SteadyFlight> steady_flight(const Airframe& airframe, const SteadyFlight& given, Solved solved,
                                          double max_angle_of_attack_rad = 0.5236);

/// Attitude of the body in a steady flight with its velocity heading along world x.
Eigen::Matrix3d attitude_of(const SteadyFlight& flight);
Eigen::Vector3d air_velocity_body_of(const SteadyFlight& flight);

}  // namespace understory
