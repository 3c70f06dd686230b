#include "sim/aircraft/aerodynamics.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

namespace understory {
namespace {

/// Lift and drag of one flat plate in the plane of its flow.
struct PlateForce {
  double along;   ///< along the plate's reference line (body x)
  double across;  ///< along the second axis of the plane (records' z, or y)
};

/// The reference line is at the angle `flow` to the air, the plate at `flow - deflection`. Lift is
/// perpendicular to the local velocity, drag opposes it.
PlateForce plate_force(double along_mps, double across_mps, double deflection_rad, double area_m2,
                       double density, double lift_factor, double drag_factor) {
  const double flow = std::atan2(across_mps, along_mps);
  const double attack = flow - deflection_rad;
  const double pressure_area = 0.5 * density * area_m2 * (along_mps * along_mps + across_mps * across_mps);
  const double lift = lift_factor * pressure_area * 2 * std::sin(attack) * std::cos(attack);
  const double drag = drag_factor * pressure_area * 2 * std::sin(attack) * std::sin(attack);
  return {lift * std::sin(flow) - drag * std::cos(flow), -lift * std::cos(flow) - drag * std::sin(flow)};
}

// From here on in the axes of the flight records: x forward, y right, z down.

struct RecordsFlow {
  Eigen::Vector3d velocity;
  Eigen::Vector3d rate;
  Eigen::Vector3d at(const Eigen::Vector3d& position) const { return velocity + rate.cross(position); }
};

void add(Wrench& sum, const Eigen::Vector3d& position, const Eigen::Vector3d& force) {
  sum.force_body_n += force;
  sum.moment_body_nm += position.cross(force);
}

void add_elevon(Wrench& sum, const Airframe& airframe, const RecordsFlow& flow, double y, double deflection,
                double wash_mps) {
  const double arm =
      0.5 * airframe.elevon_chord_m;  // mid-chord of the deflected surface; trailing edge up is -z
  const Eigen::Vector3d position(airframe.elevon_hinge_x_m - arm * std::cos(deflection), y,
                                 -arm * std::sin(deflection));
  const Eigen::Vector3d local = flow.at(position) + Eigen::Vector3d(wash_mps, 0, 0);
  const PlateForce plate =
      plate_force(local.x(), local.z(), deflection, airframe.elevon_area_m2, airframe.air_density_kgpm3,
                  airframe.elevon_lift_factor, airframe.elevon_drag_factor);
  add(sum, position, {plate.along, 0, plate.across});
}

void add_winglet(Wrench& sum, const Airframe& airframe, const RecordsFlow& flow, double y) {
  const Eigen::Vector3d position(airframe.winglet_x_m, y, -airframe.winglet_z_m);
  const Eigen::Vector3d local = flow.at(position);
  const PlateForce plate =
      plate_force(local.x(), local.y(), 0, airframe.winglet_area_m2, airframe.air_density_kgpm3, 1, 1);
  add(sum, position, {plate.along, plate.across, 0});
}

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

Wrench aerodynamic_wrench(const Airframe& airframe, const AirState& air) {
  const RecordsFlow flow{flip_yz(air.air_velocity_body_mps), flip_yz(air.angular_rate_body_radps)};
  Wrench sum;

  const PlateForce wing =
      plate_force(flow.velocity.x(), flow.velocity.z(), 0, airframe.wing_area_m2, airframe.air_density_kgpm3,
                  airframe.wing_lift_factor, airframe.wing_drag_factor);
  sum.force_body_n += Eigen::Vector3d(wing.along, 0, wing.across);  // at the centre of mass: no moment

  const double forward_mps = flow.velocity.x();
  sum.force_body_n.x() += air.thrust_n - airframe.body_drag_area_m2 * 0.5 * airframe.air_density_kgpm3 *
                                             forward_mps * std::abs(forward_mps);
  sum.moment_body_nm -= airframe.rate_damping_nmspr.cwiseProduct(flow.rate);
  sum.moment_body_nm.x() -= air.motor_torque_nm;

  add_elevon(sum, airframe, flow, -airframe.elevon_y_m, air.left_elevon_rad, air.elevon_wash_mps);
  add_elevon(sum, airframe, flow, airframe.elevon_y_m, air.right_elevon_rad, air.elevon_wash_mps);
  add_winglet(sum, airframe, flow, -airframe.winglet_y_m);
  add_winglet(sum, airframe, flow, airframe.winglet_y_m);

  return {flip_yz(sum.force_body_n), flip_yz(sum.moment_body_nm)};
}

double angle_of_attack_rad(const Eigen::Vector3d& air_velocity_body_mps) {
  return std::atan2(-air_velocity_body_mps.z(), air_velocity_body_mps.x());
}

double sideslip_rad(const Eigen::Vector3d& air_velocity_body_mps) {
  return std::atan2(air_velocity_body_mps.y(), air_velocity_body_mps.x());
}

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

double release_angle_of_attack_rad(const Airframe& airframe, double speed_mps) {
  constexpr double identified_trim_rad = 0.1915;  // 10.97 deg at 12.27 m/s
  Airframe strong = airframe;
  strong.max_thrust_n = 1e6;
  const std::optional<Trim> trim = straight_trim(strong, speed_mps);
  return trim ? trim->angle_of_attack_rad : identified_trim_rad;
}

}  // namespace understory
