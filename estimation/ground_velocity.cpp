#include "estimation/measurements.hpp"

#include "estimation/so3.hpp"

namespace understory {
namespace {

/// Derivative of the velocity in world axes by the present error.
Eigen::Matrix<double, 3, error_states> by_error(const State& now) {
  const Eigen::Matrix3d attitude = now.T_world_body.linear();
  Eigen::Matrix<double, 3, error_states> jacobian = Eigen::Matrix<double, 3, error_states>::Zero();
  jacobian.middleCols<3>(velocity_block) = attitude;
  jacobian.middleCols<3>(attitude_block) = -attitude * so3::skew(now.velocity_body_mps);
  return jacobian;
}

/// Difference between the present velocity and that of dead reckoning. Only corrections change it.
Eigen::Vector3d correction_world(const State& now) {
  return now.T_world_body.linear() * now.velocity_body_mps - now.inertial_velocity_world_mps;
}

}  // namespace

Measurement<3> ground_velocity(const State& now, const State& then, const GpsSample& sample,
                               const GroundVelocityConfig& config) {
  Measurement<3> measurement;
  measurement.innovation =
      sample.velocity_world_mps - (correction_world(now) + then.inertial_velocity_world_mps);
  measurement.jacobian = by_error(now);
  measurement.noise *= config.sigma_mps * config.sigma_mps;
  return measurement;
}

Measurement<2> ground_displacement(const State& now, const State& earlier, const State& later,
                                   const ResightingSample& sample) {
  const double interval_s = 1e-9 * static_cast<double>(sample.t_ns - sample.earlier_ns);
  const Eigen::Vector3d estimated = later.T_world_body.translation() - earlier.T_world_body.translation();
  const Eigen::Vector3d expected = interval_s * correction_world(now) + later.inertial_position_world_m -
                                   earlier.inertial_position_world_m;
  Measurement<2> measurement;
  measurement.innovation = estimated.head<2>() - sample.discrepancy_world_m - expected.head<2>();
  measurement.jacobian = interval_s * by_error(now).topRows<2>();
  measurement.noise = sample.covariance_m2;
  return measurement;
}

}  // namespace understory
