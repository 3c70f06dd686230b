#include "estimation/propagation.hpp"

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

  state.T_world_body.translation() +=
      attitude * (velocity * dt + 0.5 * dt * dt * (force_start + gravity_body));
  state.T_world_body.linear() = Eigen::Quaterniond(attitude * full_turn).normalized().toRotationMatrix();
  state.velocity_body_mps = carried + force_end * dt;

  const Eigen::Matrix3d full_jacobian = so3::right_jacobian(turn);
  const Eigen::Matrix3d half_jacobian = so3::right_jacobian(0.5 * turn);
  StepDerivatives by;
  by.rotation.setZero();
  by.rotation.middleRows<3>(attitude_block) = full_jacobian;
  by.rotation.middleRows<3>(velocity_block) =
      so3::skew(carried) * full_jacobian + 0.5 * dt * so3::skew(force_end) * half_jacobian;
  by.rotation.middleRows<3>(position_block) =
      -0.25 * dt * dt * attitude * half_turn * so3::skew(step.specific_force_body_mps2) * half_jacobian;

  by.velocity_increment.setZero();
  by.velocity_increment.middleRows<3>(velocity_block) = half_turn.transpose();
  by.velocity_increment.middleRows<3>(position_block) = 0.5 * dt * attitude * half_turn;

  by.state.setIdentity();
  by.state.block<3, 3>(attitude_block, attitude_block) = full_turn.transpose();
  by.state.block<3, 3>(velocity_block, attitude_block) = dt * full_turn.transpose() * so3::skew(gravity_body);
  by.state.block<3, 3>(velocity_block, velocity_block) = full_turn.transpose();
  by.state.block<3, 3>(position_block, attitude_block) =
      -dt * attitude * so3::skew(velocity) - 0.5 * dt * dt * attitude * so3::skew(force_start);
  by.state.block<3, 3>(position_block, velocity_block) = dt * attitude;
  by.state.middleCols<3>(rate_block).topRows<9>() = rate_sign(model) * dt * by.rotation.topRows<9>();
  return by;
}

Matrix12d propagated(const Matrix12d& covariance, const StepDerivatives& by, const ProcessNoise& noise,
                     double dt_s, FilterModel model) {
  const auto variance = [dt_s](double density) { return density * density * dt_s; };
  Matrix12d next = by.state * covariance * by.state.transpose();
  if (model == FilterModel::gyro_bias) {
    next += variance(noise.gyro_radps_rthz) * by.rotation * by.rotation.transpose();
  }
  next += variance(noise.accelerometer_mps2_rthz) * by.velocity_increment * by.velocity_increment.transpose();
  // The rate block walks during the step, not after it: half of the walk has turned the aircraft already.
  Eigen::Matrix<double, 12, 3> walk = 0.5 * dt_s * rate_sign(model) * by.rotation;
  walk.middleRows<3>(rate_block).setIdentity();
  next += variance(noise.rate_block_rthz) * walk * walk.transpose();
  return 0.5 * (next + next.transpose());
}

}  // namespace understory
