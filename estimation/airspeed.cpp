#include "estimation/measurements.hpp"

#include <algorithm>

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

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config) {
  const AirVelocity air = air_velocity(state);
  Measurement<1> measurement;
  measurement.innovation[0] = sample.airspeed_mps - state.pitot_bias_mps - air.body_mps.x();
  measurement.jacobian = air.jacobian.row(0);
  measurement.jacobian(0, pitot_bias_block) = 1;
  constexpr double reference_mps = 12;
  const double sigma_mps = config.sigma_mps * reference_mps / std::max(air.body_mps.x(), config.usable_mps);
  measurement.noise(0, 0) = sigma_mps * sigma_mps;
  return measurement;
}

}  // namespace understory
