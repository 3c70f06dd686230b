#include "estimation/error_state.hpp"

#include "estimation/so3.hpp"

namespace understory {

void inject(State& state, const ErrorVector& error, FilterModel model) {
  const Eigen::Matrix3d turned = state.T_world_body.linear() * so3::exp(error.segment<3>(attitude_block));
  // Normalised, because rounding would add up over thousands of updates.
  state.T_world_body.linear() = Eigen::Quaterniond(turned).normalized().toRotationMatrix();
  state.velocity_body_mps += error.segment<3>(velocity_block);
  state.T_world_body.translation() += error.segment<3>(position_block);
  const Eigen::Vector3d rate = error.segment<3>(rate_block);
  if (model == FilterModel::gyro_bias) state.gyro_bias_radps += rate;
  state.angular_rate_body_radps += rate_sign(model) * rate;
  state.accelerometer_bias_mps2 += error.segment<3>(accelerometer_bias_block);
  state.wind_world_mps += error.segment<2>(wind_block);
  state.gust_world_mps += error.segment<2>(gust_block);
  state.pitot_bias_mps += error[pitot_bias_block];
  state.barometer_offset_m += error[barometer_offset_block];
  state.barometer_wash_m_per_n += error[barometer_wash_block];
}

}  // namespace understory
