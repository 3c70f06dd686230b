#include "tests/validation/steady_flight.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "sim/aircraft/aerodynamics.hpp"

namespace understory {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Columns: along the velocity, to the left of it, along the lift; in body axes.
Matrix3d path_axes_body(const SteadyFlight& flight) {
  const double attack = flight.angle_of_attack_rad;
  const Vector3d along = air_velocity_body_of(flight).normalized();
  const Vector3d lift(std::sin(attack), 0, std::cos(attack));
  Matrix3d axes;
  axes << along, lift.cross(along), lift;
  return axes;
}

Wrench wrench_of(const Airframe& airframe, const SteadyFlight& flight, const Vector3d& rate_body) {
  AirState air;
  air.air_velocity_body_mps = air_velocity_body_of(flight);
  air.angular_rate_body_radps = rate_body;
  air.left_elevon_rad = flight.left_elevon_rad;
  air.right_elevon_rad = flight.right_elevon_rad;
  air.thrust_n = flight.thrust_n;
  return aerodynamic_wrench(airframe, air);
}

Vector3d rate_body_of(const SteadyFlight& flight) {
  return attitude_of(flight).transpose() * Vector3d(0, 0, -flight.turn_rate_radps);
}

/// Forces in shares of the weight, moments in shares of weight times chord.
Vector6d residual(const Airframe& airframe, const SteadyFlight& flight) {
  const Vector3d rate = rate_body_of(flight);
  const Vector3d velocity = air_velocity_body_of(flight);
  const Wrench wrench = wrench_of(airframe, flight, rate);
  const double weight_n = airframe.mass_kg * airframe.gravity_mps2;
  const Vector3d gravity_n = attitude_of(flight).transpose() * Vector3d(0, 0, -weight_n);
  const Vector3d acceleration = flight.acceleration_mps2 * velocity.normalized() + rate.cross(velocity);
  Vector6d remaining;
  remaining.head<3>() = (wrench.force_body_n + gravity_n - airframe.mass_kg * acceleration) / weight_n;
  const Vector3d momentum = airframe.inertia_kgm2.cwiseProduct(rate);
  remaining.tail<3>() = (wrench.moment_body_nm - rate.cross(momentum)) / (weight_n * airframe.chord_m);
  return remaining;
}

double& solved_value(SteadyFlight& flight, Solved solved) {
  if (solved == Solved::thrust) return flight.thrust_n;
  if (solved == Solved::acceleration) return flight.acceleration_mps2;
  return flight.climb_angle_rad;
}

SteadyFlight moved(SteadyFlight flight, Solved solved, const Vector6d& by) {
  flight.angle_of_attack_rad += by[0];
  flight.sideslip_rad += by[1];
  flight.left_elevon_rad += by[2];
  flight.right_elevon_rad += by[3];
  flight.turn_rate_radps += by[4];
  solved_value(flight, solved) += by[5];
  return flight;
}

}  // namespace

double SteadyFlight::radius_m() const {
  return std::abs(airspeed_mps * std::cos(climb_angle_rad) / turn_rate_radps);
}

double SteadyFlight::sink_mps() const { return -airspeed_mps * std::sin(climb_angle_rad); }

Vector3d air_velocity_body_of(const SteadyFlight& flight) {
  const double attack = flight.angle_of_attack_rad, slip = flight.sideslip_rad;
  return flight.airspeed_mps *
         Vector3d(std::cos(attack) * std::cos(slip), std::sin(slip), -std::sin(attack) * std::cos(slip));
}

Matrix3d attitude_of(const SteadyFlight& flight) {
  const Matrix3d path_world = (Eigen::AngleAxisd(-flight.climb_angle_rad, Vector3d::UnitY()) *
                               Eigen::AngleAxisd(flight.bank_rad, Vector3d::UnitX()))
                                  .toRotationMatrix();
  return path_world * path_axes_body(flight).transpose();
}

std::optional<SteadyFlight> steady_flight(const Airframe& airframe, const SteadyFlight& given, Solved solved,
                                          double max_angle_of_attack_rad) {
  constexpr int maximum_iterations = 100;
  constexpr double difference = 1e-6, tolerance = 1e-10, longest_step_rad = 0.2;
  SteadyFlight flight = given;
  flight.angle_of_attack_rad = flight.left_elevon_rad = flight.right_elevon_rad = 0.2;
  flight.sideslip_rad = 0;
  // The turn of a coordinated bank: what Newton starts from.
  flight.turn_rate_radps = airframe.gravity_mps2 * std::tan(given.bank_rad) / given.airspeed_mps;
  for (int iteration = 0; iteration < maximum_iterations; ++iteration) {
    const Vector6d now = residual(airframe, flight);
    if (!now.allFinite()) return std::nullopt;
    if (now.norm() < tolerance) {
      const Vector3d lift = path_axes_body(flight).col(2);
      const Wrench wrench = wrench_of(airframe, flight, rate_body_of(flight));
      flight.load_factor = wrench.force_body_n.dot(lift) / (airframe.mass_kg * airframe.gravity_mps2);
      if (flight.angle_of_attack_rad <= 0 || flight.angle_of_attack_rad > max_angle_of_attack_rad)
        return std::nullopt;
      return flight;
    }
    Eigen::Matrix<double, 6, 6> jacobian;
    for (int i = 0; i < 6; ++i) {
      const Vector6d nudge = difference * Vector6d::Unit(i);
      jacobian.col(i) = (residual(airframe, moved(flight, solved, nudge)) -
                         residual(airframe, moved(flight, solved, -nudge))) /
                        (2 * difference);
    }
    Vector6d correction = -jacobian.fullPivLu().solve(now);
    const double angles = correction.head<4>().cwiseAbs().maxCoeff();
    if (angles > longest_step_rad)
      correction *= longest_step_rad / angles;  // the plates repeat every half turn
    flight = moved(flight, solved, correction);
  }
  return std::nullopt;
}

}  // namespace understory
