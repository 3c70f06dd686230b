#include "estimation/air_velocity.hpp"

#include "estimation/so3.hpp"

namespace understory {

AirVelocity air_velocity(const State& state) {
  const Eigen::Matrix3d R_body_world = state.T_world_body.linear().transpose();
  const Eigen::Vector3d moving_air_body =
      R_body_world.leftCols<2>() * (state.wind_world_mps + state.gust_world_mps);
  AirVelocity air;
  air.body_mps = state.velocity_body_mps - moving_air_body;
  air.jacobian.middleCols<3>(velocity_block).setIdentity();
  air.jacobian.middleCols<3>(attitude_block) = -so3::skew(moving_air_body);
  air.jacobian.middleCols<2>(wind_block) = -R_body_world.leftCols<2>();
  air.jacobian.middleCols<2>(gust_block) = -R_body_world.leftCols<2>();
  return air;
}

}  // namespace understory
