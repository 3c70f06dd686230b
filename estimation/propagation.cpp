#include "estimation/propagation.hpp"

#include <cmath>

#include "estimation/so3.hpp"

namespace understory {

StepDerivatives advance(State& state, const InertialStep& step, double gravity_mps2, FilterModel model) {
  const double dt = step.dt_s;
  const Eigen::Vector3d turn = step.angular_rate_body_radps * dt;
  const Eigen::Matrix3d attitude = state.T_world_body.linear();
  const Eigen::Matrix3d full_turn = so3::exp(turn), half_turn = so3::exp(0.5 * turn);
  const Eigen::Vector3d gravity_body = attitude.transpose() * Eigen::Vector3d(0, 0, -gravity_mps2);
  const Eigen::Vector3d force_start = half_turn * step.specific_force_body_mps2;  // in the axes of the start
  const Eigen::Vector3d force_end = half_turn.transpose() * step.specific_force_body_mps2;
  const Eigen::Vector3d velocity = state.velocity_body_mps;
  const Eigen::Vector3d carried = full_turn.transpose() * (velocity + gravity_body * dt);

  const Eigen::Vector3d felt_world = attitude * (force_start + gravity_body) * dt;
  state.T_world_body.translation() += attitude * (velocity * dt) + 0.5 * dt * felt_world;
  state.inertial_position_world_m += dt * (state.inertial_velocity_world_mps + 0.5 * felt_world);
  state.inertial_velocity_world_mps += felt_world;
  state.T_world_body.linear() = Eigen::Quaterniond(attitude * full_turn).normalized().toRotationMatrix();
  state.velocity_body_mps = carried + force_end * dt;

  const Eigen::Matrix3d full_jacobian = so3::right_jacobian(turn);
  const Eigen::Matrix3d half_jacobian = so3::right_jacobian(0.5 * turn);
  StepDerivatives by;
  by.rotation.middleRows<3>(attitude_block) = full_jacobian;
  by.rotation.middleRows<3>(velocity_block) =
      so3::skew(carried) * full_jacobian + 0.5 * dt * so3::skew(force_end) * half_jacobian;
  by.rotation.middleRows<3>(position_block) =
      -0.25 * dt * dt * attitude * half_turn * so3::skew(step.specific_force_body_mps2) * half_jacobian;

  by.velocity_increment.middleRows<3>(attitude_block).setZero();
  by.velocity_increment.middleRows<3>(velocity_block) = half_turn.transpose();
  by.velocity_increment.middleRows<3>(position_block) = 0.5 * dt * attitude * half_turn;

  by.state.setZero();
  by.state.block<3, 3>(attitude_block, attitude_block) = full_turn.transpose();
  by.state.block<3, 3>(velocity_block, attitude_block) = dt * full_turn.transpose() * so3::skew(gravity_body);
  by.state.block<3, 3>(velocity_block, velocity_block) = full_turn.transpose();
  by.state.block<3, 3>(position_block, attitude_block) =
      -dt * attitude * so3::skew(velocity) - 0.5 * dt * dt * attitude * so3::skew(force_start);
  by.state.block<3, 3>(position_block, velocity_block) = dt * attitude;
  by.state.block<3, 3>(position_block, position_block).setIdentity();
  by.state.middleCols<3>(rate_block) = rate_sign(model) * dt * by.rotation;
  by.state.middleCols<3>(accelerometer_bias_block) = -dt * by.velocity_increment;
  return by;
}

void propagate(ErrorCovariance& covariance, const StepDerivatives& by, const ProcessNoise& noise, double dt_s,
               FilterModel model) {
  constexpr int resting_rows = error_states - motion_rows;
  const auto variance = [dt_s](double density) { return density * density * dt_s; };
  const Eigen::Matrix<double, motion_rows, error_states> moved =
      by.state * covariance.topRows<moving_columns>();
  Eigen::Matrix<double, motion_rows, motion_rows> motion =
      moved.leftCols<moving_columns>() * by.state.transpose();
  if (model == FilterModel::gyro_bias)
    motion.noalias() += variance(noise.gyro_radps_rthz) * by.rotation * by.rotation.transpose();
  motion.noalias() +=
      variance(noise.accelerometer_mps2_rthz) * by.velocity_increment * by.velocity_increment.transpose();
  // The rate block walks during the step, not after it: half of the walk has turned the aircraft already.
  const Eigen::Matrix<double, motion_rows, 3> walked = 0.5 * dt_s * rate_sign(model) * by.rotation;
  motion.noalias() += variance(noise.rate_block_rthz) * walked * walked.transpose();
  covariance.topLeftCorner<motion_rows, motion_rows>() = 0.5 * (motion + motion.transpose());
  covariance.topRightCorner<motion_rows, resting_rows>() = moved.rightCols<resting_rows>();
  covariance.block<motion_rows, 3>(0, rate_block) += variance(noise.rate_block_rthz) * walked;

  const double kept = std::exp(-dt_s / noise.gust_time_s);
  covariance.middleCols<2>(gust_block) *= kept;
  covariance.block<2, error_states - motion_rows>(gust_block, motion_rows) *= kept;
  covariance.bottomLeftCorner<resting_rows, motion_rows>() =
      covariance.topRightCorner<motion_rows, resting_rows>().transpose();

  const auto add = [&](int block, int count, double by_m2) {
    covariance.diagonal().segment(block, count).array() += by_m2;
  };
  add(rate_block, 3, variance(noise.rate_block_rthz));
  add(accelerometer_bias_block, 3, variance(noise.accelerometer_bias_walk_rthz));
  add(wind_block, 2, variance(noise.wind_walk_rthz));
  add(gust_block, 2, (1 - kept * kept) * noise.gust_sigma_mps * noise.gust_sigma_mps);
  add(pitot_bias_block, 1, variance(noise.pitot_bias_walk_rthz));
  add(barometer_offset_block, 1, variance(noise.barometer_offset_walk_m_rts));
}

}  // namespace understory
