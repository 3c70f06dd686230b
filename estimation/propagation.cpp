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
  const auto variance = [dt_s](double density) { return density * density * dt_s; };
  // Block by block, because half of by.state is zero. Transposed, because the columns of the symmetric
  // covariance are contiguous in memory.
  constexpr int attitude = attitude_block, velocity = velocity_block, position = position_block;
  constexpr int rate = rate_block, bias = accelerometer_bias_block;
  const auto from = [&](int columns) { return covariance.middleCols<3>(columns); };
  const auto part = [&](int rows, int columns) { return by.state.block<3, 3>(rows, columns).transpose(); };
  Eigen::Matrix<double, error_states, motion_rows> moved;  // (by.state * covariance)'
  moved.middleCols<3>(attitude) =
      from(attitude).lazyProduct(part(attitude, attitude)) + from(rate).lazyProduct(part(attitude, rate));
  moved.middleCols<3>(velocity) = from(attitude).lazyProduct(part(velocity, attitude)) +
                                  from(velocity).lazyProduct(part(velocity, velocity)) +
                                  from(rate).lazyProduct(part(velocity, rate)) +
                                  from(bias).lazyProduct(part(velocity, bias));
  moved.middleCols<3>(position) = from(position) + from(attitude).lazyProduct(part(position, attitude)) +
                                  from(velocity).lazyProduct(part(position, velocity)) +
                                  from(rate).lazyProduct(part(position, rate)) +
                                  from(bias).lazyProduct(part(position, bias));

  // The rate block walks during the step, so half of the walk has already turned the aircraft.
  const double walked = 0.5 * dt_s * rate_sign(model), walk = variance(noise.rate_block_rthz);
  const double turned =
      walk * walked * walked + (model == FilterModel::gyro_bias ? variance(noise.gyro_radps_rthz) : 0.0);
  const double pushed = variance(noise.accelerometer_mps2_rthz);
  // Rows and columns of the motion's covariance: the lower blocks, then mirrored.
  const auto motion = [&](int rows, int columns) -> Eigen::Matrix3d {
    const auto product = [&](int through) {
      return moved.block<3, 3>(through, rows).transpose().lazyProduct(part(columns, through));
    };
    Eigen::Matrix3d block = product(attitude) + product(rate);
    if (columns != attitude)
      block += product(velocity) + product(bias) +
               pushed * by.velocity_increment.middleRows<3>(rows).lazyProduct(
                            by.velocity_increment.middleRows<3>(columns).transpose());
    if (columns == position) block += moved.block<3, 3>(position, rows).transpose();
    return block + turned * by.rotation.middleRows<3>(rows).lazyProduct(
                                by.rotation.middleRows<3>(columns).transpose());
  };
  for (const int rows : {attitude, velocity, position}) {
    for (int columns = attitude; columns < rows; columns += 3) {
      const Eigen::Matrix3d block = motion(rows, columns);
      covariance.block<3, 3>(rows, columns) = block;
      covariance.block<3, 3>(columns, rows) = block.transpose();
    }
    const Eigen::Matrix3d block = motion(rows, rows);
    covariance.block<3, 3>(rows, rows) = 0.5 * (block + block.transpose());
  }
  moved.middleRows<3>(rate) += walk * walked * by.rotation.transpose();

  const double kept = std::exp(-dt_s / noise.gust_time_s);
  constexpr int resting_rows = error_states - motion_rows;
  moved.middleRows<2>(gust_block) *= kept;
  covariance.bottomLeftCorner<resting_rows, motion_rows>() = moved.bottomRows<resting_rows>();
  covariance.topRightCorner<motion_rows, resting_rows>() = moved.bottomRows<resting_rows>().transpose();
  covariance.block<resting_rows, 2>(motion_rows, gust_block) *= kept;
  covariance.block<2, resting_rows>(gust_block, motion_rows) *= kept;

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
