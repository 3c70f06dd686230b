#include "sim/aircraft/trim.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "sim/aircraft/aerodynamics.hpp"

namespace understory {
namespace {

/// Unknowns: angle of attack (rad), elevon (rad), thrust (N). Residual: forces along body x and z in shares
/// of the weight, pitching moment in shares of weight times chord.
Eigen::Vector3d residual(const Airframe& airframe, double airspeed_mps, double climb_angle_rad,
                         const Eigen::Vector3d& unknowns) {
  const double attack = unknowns.x();
  AirState air;
  air.air_velocity_body_mps = airspeed_mps * Eigen::Vector3d(std::cos(attack), 0, -std::sin(attack));
  air.left_elevon_rad = air.right_elevon_rad = unknowns.y();
  air.thrust_n = unknowns.z();
  const Wrench wrench = aerodynamic_wrench(airframe, air);
  const double weight_n = airframe.mass_kg * airframe.gravity_mps2;
  const double pitch = climb_angle_rad + attack;
  return {(wrench.force_body_n.x() - weight_n * std::sin(pitch)) / weight_n,
          (wrench.force_body_n.z() - weight_n * std::cos(pitch)) / weight_n,
          wrench.moment_body_nm.y() / (weight_n * airframe.chord_m)};
}

}  // namespace

std::optional<Trim> straight_trim(const Airframe& airframe, double airspeed_mps, double climb_angle_rad,
                                  double max_angle_of_attack_rad) {
  constexpr int maximum_iterations = 50;
  constexpr double difference = 1e-6;
  constexpr double tolerance = 1e-10;
  Eigen::Vector3d unknowns(0.2, 0.2, 0.5 * airframe.max_thrust_n);
  for (int iteration = 0; iteration < maximum_iterations; ++iteration) {
    const Eigen::Vector3d now = residual(airframe, airspeed_mps, climb_angle_rad, unknowns);
    if (!now.allFinite()) return std::nullopt;
    if (now.norm() < tolerance) {
      const bool flyable = unknowns.x() > 0 && unknowns.x() <= max_angle_of_attack_rad &&
                           unknowns.y() >= airframe.elevon_min_rad &&
                           unknowns.y() <= airframe.elevon_max_rad && unknowns.z() >= 0 &&
                           unknowns.z() <= airframe.max_thrust_n;
      if (!flyable) return std::nullopt;
      return Trim{airspeed_mps, climb_angle_rad, unknowns.x(), unknowns.y(), unknowns.z()};
    }
    Eigen::Matrix3d jacobian;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d nudge = difference * Eigen::Vector3d::Unit(i);
      jacobian.col(i) = (residual(airframe, airspeed_mps, climb_angle_rad, unknowns + nudge) -
                         residual(airframe, airspeed_mps, climb_angle_rad, unknowns - nudge)) /
                        (2 * difference);
    }
    Eigen::Vector3d correction = -jacobian.fullPivLu().solve(now);
    const double angles = correction.head<2>().cwiseAbs().maxCoeff();
    if (angles > 0.2) correction *= 0.2 / angles;  // small steps: the plates' curves repeat every half turn
    unknowns += correction;
  }
  return std::nullopt;
}

}  // namespace understory
