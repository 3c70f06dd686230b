#include "tests/validation/flight_mechanics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Vector3d air_velocity_body(const SteadyFlight& flight) {
  const double attack = flight.angle_of_attack_rad, slip = flight.sideslip_rad;
  return flight.airspeed_mps *
         Vector3d(std::cos(attack) * std::cos(slip), std::sin(slip), -std::sin(attack) * std::cos(slip));
}

Vector3d lift_axis_body(const SteadyFlight& flight) {
  return {std::sin(flight.angle_of_attack_rad), 0, std::cos(flight.angle_of_attack_rad)};
}

/// Of the body, the velocity heading along world x.
Matrix3d attitude(const SteadyFlight& flight) {
  const Vector3d along = air_velocity_body(flight).normalized(), lift = lift_axis_body(flight);
  Matrix3d path_axes_body;
  path_axes_body << along, lift.cross(along), lift;
  const Matrix3d path_axes_world = (Eigen::AngleAxisd(-flight.climb_angle_rad, Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(flight.bank_rad, Vector3d::UnitX()))
                                       .toRotationMatrix();
  return path_axes_world * path_axes_body.transpose();
}

/// What is left of the steady flight's equations: forces in shares of the weight, moments in shares of weight
/// times chord.
Vector6d residual(const Airframe& airframe, const SteadyFlight& flight) {
  const BodyMotion change = rate_of_change(airframe, flight.motion(), flight.air());
  const double weight_n = airframe.mass_kg * airframe.gravity_mps2;
  Vector6d remaining;
  remaining.head<3>() =
      (change.head<3>() - flight.acceleration_mps2 * air_velocity_body(flight).normalized()) /
      airframe.gravity_mps2;
  remaining.tail<3>() =
      airframe.inertia_kgm2.cwiseProduct(change.segment<3>(3)) / (weight_n * airframe.chord_m);
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

constexpr std::array<int, 4> along{0, 2, 4, 7};   // u, w, q, pitch
constexpr std::array<int, 4> across{1, 3, 5, 6};  // v, p, r, roll

Matrix8d jacobian(const Airframe& airframe, const BodyMotion& motion, const AirState& surfaces) {
  constexpr double difference = 1e-5;
  Matrix8d slopes;
  for (int i = 0; i < 8; ++i) {
    const BodyMotion nudge = difference * BodyMotion::Unit(i);
    slopes.col(i) = (rate_of_change(airframe, motion + nudge, surfaces) -
                     rate_of_change(airframe, motion - nudge, surfaces)) /
                    (2 * difference);
  }
  return slopes;
}

Matrix4d block(const Matrix8d& all, const std::array<int, 4>& rows, const std::array<int, 4>& columns) {
  Matrix4d part;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      part(i, j) = all(rows[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
  return part;
}

/// One mode for each real eigenvalue and each pair, fastest first.
std::vector<Mode> modes_of(const Matrix4d& system) {
  std::vector<Mode> found;
  const Eigen::EigenSolver<Matrix4d> solver(system, false);
  for (const std::complex<double>& value : solver.eigenvalues())
    if (value.imag() >= 0) found.push_back({"", value});
  std::sort(found.begin(), found.end(),
            [](const Mode& a, const Mode& b) { return a.frequency_radps() > b.frequency_radps(); });
  return found;
}

/// The two fastest eigenvalues are the short period, the two slowest the phugoid.
void name_longitudinal(std::vector<Mode>& found) {
  int eigenvalues = 0;
  for (Mode& mode : found) {
    mode.name = eigenvalues < 2 ? "short period" : "phugoid";
    if (!mode.swings()) mode.name += eigenvalues % 2 == 0 ? ", fast part" : ", slow part";
    eigenvalues += mode.swings() ? 2 : 1;
  }
}

void name_lateral(std::vector<Mode>& found) {
  bool rolled = false;
  for (Mode& mode : found) {
    if (mode.swings()) {
      mode.name = "dutch roll";
    } else {
      mode.name = rolled ? "spiral" : "roll subsidence";
      rolled = true;
    }
  }
}

}  // namespace

BodyMotion rate_of_change(const Airframe& airframe, const BodyMotion& motion, const AirState& surfaces) {
  const Vector3d velocity = motion.head<3>(), rate = motion.segment<3>(3);
  const double roll = motion[6], pitch = motion[7];
  AirState air = surfaces;
  air.air_velocity_body_mps = velocity;
  air.angular_rate_body_radps = rate;
  const Wrench wrench = aerodynamic_wrench(airframe, air);
  const Vector3d up_body(-std::sin(pitch), std::sin(roll) * std::cos(pitch),
                         std::cos(roll) * std::cos(pitch));
  const Vector3d& inertia = airframe.inertia_kgm2;
  BodyMotion change;
  change.head<3>() =
      wrench.force_body_n / airframe.mass_kg - airframe.gravity_mps2 * up_body - rate.cross(velocity);
  change.segment<3>(3) =
      (wrench.moment_body_nm - rate.cross(inertia.cwiseProduct(rate))).cwiseQuotient(inertia);
  change[6] = rate.x() + std::tan(pitch) * (rate.y() * std::sin(roll) + rate.z() * std::cos(roll));
  change[7] = rate.y() * std::cos(roll) - rate.z() * std::sin(roll);
  return change;
}

double SteadyFlight::radius_m() const {
  return std::abs(airspeed_mps * std::cos(climb_angle_rad) / turn_rate_radps);
}

double SteadyFlight::sink_mps() const { return -airspeed_mps * std::sin(climb_angle_rad); }

AirState SteadyFlight::air() const {
  AirState air;
  air.air_velocity_body_mps = air_velocity_body(*this);
  air.angular_rate_body_radps = attitude(*this).transpose() * Vector3d(0, 0, -turn_rate_radps);
  air.left_elevon_rad = left_elevon_rad;
  air.right_elevon_rad = right_elevon_rad;
  air.thrust_n = thrust_n;
  return air;
}

BodyMotion SteadyFlight::motion() const {
  const AirState now = air();
  const Matrix3d R = attitude(*this);
  BodyMotion motion;
  motion << now.air_velocity_body_mps, now.angular_rate_body_radps, std::atan2(R(2, 1), R(2, 2)),
      std::asin(-R(2, 0));
  return motion;
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
      flight.load_factor =
          aerodynamic_wrench(airframe, flight.air()).force_body_n.dot(lift_axis_body(flight)) /
          (airframe.mass_kg * airframe.gravity_mps2);
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

std::optional<SteadyFlight> full_thrust_turn(const Airframe& airframe, double speed_mps, double bank_rad,
                                             double max_angle_of_attack_rad) {
  const SteadyFlight given{
      .airspeed_mps = speed_mps, .bank_rad = bank_rad, .thrust_n = airframe.max_thrust_n};
  return steady_flight(airframe, given, Solved::acceleration, max_angle_of_attack_rad);
}

SteadyFlight steepest_turn(const Airframe& airframe, double speed_mps, double acceleration_mps2,
                           double max_angle_of_attack_rad) {
  const double steepest_rad = border(0, 85 * std::numbers::pi / 180, [&](double bank_rad) {
    const auto turn = full_thrust_turn(airframe, speed_mps, bank_rad, max_angle_of_attack_rad);
    return turn && turn->acceleration_mps2 >= acceleration_mps2;
  });
  if (const auto turn = full_thrust_turn(airframe, speed_mps, steepest_rad, max_angle_of_attack_rad))
    return *turn;
  const double none = std::nan("");
  return {.airspeed_mps = speed_mps, .bank_rad = none, .turn_rate_radps = none, .load_factor = none};
}

Modes modes(const Airframe& airframe, const SteadyFlight& trim) {
  const Matrix8d all = jacobian(airframe, trim.motion(), trim.air());
  Modes found{modes_of(block(all, along, along)), modes_of(block(all, across, across)), 0};
  found.coupling = std::max(block(all, along, across).cwiseAbs().maxCoeff(),
                            block(all, across, along).cwiseAbs().maxCoeff());
  name_longitudinal(found.longitudinal);
  name_lateral(found.lateral);
  return found;
}

}  // namespace understory
