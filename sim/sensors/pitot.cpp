#include "sim/sensors/pitot.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

/// The share of the dynamic pressure that reaches a tube at an angle to the air.
double recovered(const Eigen::Vector3d& air_velocity_body, const PitotConfig& config) {
  if (config.recovery_loss <= 0) return 1;
  const double angle_rad = std::atan2(air_velocity_body.tail<2>().norm(), air_velocity_body.x());
  const double beyond_rad = std::max(0.0, angle_rad - config.recovery_angle_rad);
  return std::max(0.0, 1 - config.recovery_loss * beyond_rad * beyond_rad);
}

}  // namespace

Pitot::Pitot(const PitotConfig& config, double air_density_kgpm3, std::uint64_t seed)
    : config_(config),
      air_density_kgpm3_(air_density_kgpm3),
      noise_(seed),
      pressure_bias_pa_(noise_.gaussian(config.pressure_bias_pa)) {}

PitotSample Pitot::measure(const Truth& truth) {
  const Eigen::Vector3d air_velocity_body =
      truth.T_world_body.linear().transpose() * (truth.velocity_world_mps - truth.wind_world_mps);
  const double forward_mps = std::max(0.0, air_velocity_body.x());
  const double dynamic_pa =
      0.5 * air_density_kgpm3_ * forward_mps * forward_mps * recovered(air_velocity_body, config_);
  double pressure_pa = converted(dynamic_pa + pressure_bias_pa_ + noise_.gaussian(config_.pressure_noise_pa),
                                 config_.pressure_range_pa, config_.pressure_step_pa);
  if (std::abs(pressure_pa) < config_.dead_zone_pa) pressure_pa = 0;
  PitotSample sample;
  sample.t_ns = truth.t_ns;
  sample.airspeed_mps = std::sqrt(2 * std::max(0.0, pressure_pa) / air_density_kgpm3_) + config_.bias_mps;
  return sample;
}

}  // namespace understory
