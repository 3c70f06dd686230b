#include "estimation/measurements.hpp"

namespace understory {
namespace {

Measurement<1> zero_sideslip(const State& state, const SideslipConfig& config) {
  const AirVelocity air = air_velocity(state);
  Measurement<1> measurement;
  measurement.innovation[0] = -air.body_mps.y();
  measurement.jacobian = air.jacobian.row(1);
  measurement.noise(0, 0) = config.zero_sigma_mps * config.zero_sigma_mps;
  return measurement;
}

}  // namespace

Measurement<1> sideslip(const State& state, double lateral_mps2, const SideslipConfig& config,
                        FilterModel model) {
  if (config.model == SideslipModel::zero) return zero_sideslip(state, config);
  const AirVelocity air = air_velocity(state);
  const Eigen::Vector3d& arm = config.winglets_body_m;
  const Eigen::Vector3d local = air.body_mps + state.angular_rate_body_radps.cross(arm);
  const double speed = local.head<2>().norm();
  const double factor = config.air_density_kgpm3 * config.winglets_area_m2 / config.mass_kg;
  const double predicted = -factor * speed * local.y();

  Measurement<1> measurement;
  measurement.innovation[0] = lateral_mps2 - state.accelerometer_bias_mps2.y() - predicted;
  const Eigen::RowVector3d by_local(-factor * local.x() * local.y() / speed,
                                    -factor * (speed + local.y() * local.y() / speed), 0.0);
  measurement.jacobian = by_local * air.jacobian;
  const Eigen::RowVector3d by_rate =
      arm.cross(by_local.transpose()).transpose();  // g . (w x a) = w . (a x g)
  measurement.jacobian.segment<3>(rate_block) = rate_sign(model) * by_rate;
  measurement.jacobian(0, accelerometer_bias_block + 1) = 1;
  const double wrong = config.model_error * predicted;
  measurement.noise(0, 0) = config.sigma_mps2 * config.sigma_mps2 + wrong * wrong;
  return measurement;
}

}  // namespace understory
