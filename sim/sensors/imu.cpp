#include "sim/sensors/imu.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

enum Effect : std::uint64_t { gyro_gain = 1, accelerometer_gain, gyro_wander, accelerometer_wander };

Eigen::Matrix3d gain(double scale, double misalignment, std::uint64_t seed) {
  NoiseSource noise(seed);
  Eigen::Matrix3d drawn;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      drawn(row, column) = noise.gaussian(row == column ? scale : misalignment);
    }
  }
  return Eigen::Matrix3d::Identity() + drawn;
}

}  // namespace

Imu::Imu(const ImuConfig& config, std::uint64_t seed)
    : config_(config),
      noise_(seed),
      gyro_bias_radps_(noise_.gaussian_vector(config.gyro_bias_radps)),
      accelerometer_bias_mps2_(noise_.gaussian_vector(config.accelerometer_bias_mps2)),
      gyro_gain_(gain(config.gyro_scale, config.gyro_misalignment, effect_seed(seed, Effect::gyro_gain))),
      accelerometer_gain_(gain(config.accelerometer_scale, config.accelerometer_misalignment,
                               effect_seed(seed, Effect::accelerometer_gain))),
      gyro_wander_(config.gyro_bias_instability_radps, config.gyro_walk_radpsps_rthz,
                   effect_seed(seed, Effect::gyro_wander)),
      accelerometer_wander_(config.accelerometer_bias_instability_mps2, config.accelerometer_walk_mps2ps_rthz,
                            effect_seed(seed, Effect::accelerometer_wander)) {}

Eigen::Vector3d Imu::shake(const Truth& truth) {
  const double thrust_n = std::max(0.0, truth.thrust_n);
  const double elapsed_s = last_t_ns_ < 0 ? 0 : static_cast<double>(truth.t_ns - last_t_ns_) * 1e-9;
  propeller_turns_ += config_.propeller_hz_at_1n * std::sqrt(thrust_n) * elapsed_s;
  propeller_turns_ -= std::floor(propeller_turns_);
  last_t_ns_ = truth.t_ns;
  const double angle_rad = 2 * M_PI * propeller_turns_;
  return thrust_n * Eigen::Vector3d(0, std::cos(angle_rad), std::sin(angle_rad));
}

ImuSample Imu::measure(const Truth& truth) {
  ImuSample sample;
  sample.t_ns = truth.t_ns;
  const Eigen::Vector3d shake_n = shake(truth);
  // The imbalance acts far from the centre of mass, so it turns the nose too. With the lever along x, the
  // rate (the integral of lever x force over a turn) has the direction of the force.
  const Eigen::Vector3d rate = gyro_gain_ * truth.angular_rate_body_radps + gyro_bias_radps_ +
                               gyro_wander_.at(truth.t_ns) + config_.gyro_vibration_radpspn * shake_n +
                               noise_.gaussian_vector(config_.gyro_noise_radps);
  const Eigen::Vector3d force = accelerometer_gain_ * truth.specific_force_body_mps2 +
                                accelerometer_bias_mps2_ + accelerometer_wander_.at(truth.t_ns) +
                                config_.accelerometer_vibration_mps2pn * shake_n +
                                noise_.gaussian_vector(config_.accelerometer_noise_mps2);
  sample.angular_rate_body_radps = converted(rate, config_.gyro_range_radps, config_.gyro_step_radps);
  sample.specific_force_body_mps2 =
      converted(force, config_.accelerometer_range_mps2, config_.accelerometer_step_mps2);
  return sample;
}

}  // namespace understory
