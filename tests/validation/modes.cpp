#include "tests/validation/modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace understory {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

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

Modes modes(const Airframe& airframe, const SteadyFlight& trim) {
  BodyMotion motion = BodyMotion::Zero();
  motion.head<3>() = air_velocity_body_of(trim);
  motion[7] = -(trim.climb_angle_rad + trim.angle_of_attack_rad);
  AirState surfaces;
  surfaces.left_elevon_rad = trim.left_elevon_rad;
  surfaces.right_elevon_rad = trim.right_elevon_rad;
  surfaces.thrust_n = trim.thrust_n;
  const Matrix8d all = jacobian(airframe, motion, surfaces);
  Modes found{modes_of(block(all, along, along)), modes_of(block(all, across, across)), 0};
  found.coupling = std::max(block(all, along, across).cwiseAbs().maxCoeff(),
                            block(all, across, along).cwiseAbs().maxCoeff());
  name_longitudinal(found.longitudinal);
  name_lateral(found.lateral);
  return found;
}

}  // namespace understory
