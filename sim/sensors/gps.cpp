#include "sim/sensors/gps.hpp"

namespace understory {

Gps::Gps(const GpsConfig& config, std::uint64_t seed)
    : config_(config), noise_(seed), drift_(config.position_drift_m, config.position_drift_time_s, noise_) {}

GpsSample Gps::measure(const Truth& truth) {
  if (last_t_ns_ >= 0) drift_.after(static_cast<double>(truth.t_ns - last_t_ns_) * 1e-9, noise_);
  last_t_ns_ = truth.t_ns;
  const Eigen::Vector3d axes(1, 1, config_.vertical_factor);
  const Eigen::Vector3d position_error_m = drift_.value() + noise_.gaussian_vector(config_.position_noise_m);
  GpsSample sample;
  sample.t_ns = truth.t_ns;
  sample.position_world_m = truth.T_world_body.translation() + axes.cwiseProduct(position_error_m);
  sample.velocity_world_mps = truth.velocity_world_mps + noise_.gaussian_vector(config_.velocity_noise_mps);
  return sample;
}

}  // namespace understory
