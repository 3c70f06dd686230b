#include "estimation/error_state.hpp"

#include "estimation/so3.hpp"

namespace understory {

void inject(State& state, const Vector12d& error, FilterModel model) {
  const Eigen::Matrix3d turned = state.T_world_body.linear() * so3::exp(error.segment<3>(attitude_block));
  // Back onto the manifold: rounding would otherwise add up over thousands of updates.
  state.T_world_body.linear() = Eigen::Quaterniond(turned).normalized().toRotationMatrix();
  state.velocity_body_mps += error.segment<3>(velocity_block);
  state.T_world_body.translation() += error.segment<3>(position_block);
  const Eigen::Vector3d last = error.segment<3>(rate_block);
  if (model == FilterModel::gyro_bias) state.gyro_bias_radps += last;
  state.angular_rate_body_radps += rate_sign(model) * last;
}

}  // namespace understory
