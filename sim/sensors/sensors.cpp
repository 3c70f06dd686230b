#include "sim/sensors/sensors.hpp"

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

/// The share of the dynamic pressure that reaches a tube at an angle to the air.
double recovered(const Eigen::Vector3d& air_velocity_body, const PitotConfig& config) {
  if (config.recovery_loss <= 0) return 1;
  const double angle_rad = std::atan2(air_velocity_body.tail<2>().norm(), air_velocity_body.x());
  const double beyond_rad = std::max(0.0, angle_rad - config.recovery_angle_rad);
  return std::max(0.0, 1 - config.recovery_loss * beyond_rad * beyond_rad);
}

Eigen::Matrix3d bending(double sigma, std::uint64_t seed) {
  NoiseSource noise(seed);
  Eigen::Matrix3d drawn;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      drawn(row, column) = drawn(column, row) = noise.gaussian(sigma);
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

Barometer::Barometer(const BarometerConfig& config, std::uint64_t seed) : config_(config), noise_(seed) {}

BarometerSample Barometer::measure(const Truth& truth) {
  if (last_t_ns_ >= 0) {
    const double elapsed_s = static_cast<double>(truth.t_ns - last_t_ns_) * 1e-9;
    const double kept = std::exp(-elapsed_s / config_.drift_time_s);
    offset_m_ = kept * offset_m_ + noise_.gaussian(config_.drift_m * std::sqrt(1 - kept * kept));
  }
  last_t_ns_ = truth.t_ns;
  constexpr double highest_m = 10000;
  BarometerSample sample;
  sample.t_ns = truth.t_ns;
  sample.altitude_m = converted(truth.T_world_body.translation().z() + offset_m_ +
                                    config_.wash_m_per_n * truth.thrust_n + noise_.gaussian(config_.noise_m),
                                highest_m, config_.step_m);
  return sample;
}

Magnetometer::Magnetometer(const MagnetometerConfig& config, std::uint64_t seed)
    : config_(config),
      noise_(seed),
      hard_iron_body_ut_(noise_.gaussian_vector(config.hard_iron_ut)),
      soft_iron_(bending(config.soft_iron, effect_seed(seed, 1))) {}

MagnetometerSample Magnetometer::measure(const Truth& truth) {
  const Eigen::Vector3d field_world_ut =
      config_.field_ut *
      Eigen::Vector3d(0, std::cos(config_.inclination_rad), -std::sin(config_.inclination_rad));
  const Eigen::Vector3d true_field_body_ut = truth.T_world_body.linear().transpose() * field_world_ut;
  const Eigen::Vector3d field_body_ut =
      soft_iron_ * true_field_body_ut + hard_iron_body_ut_ + noise_.gaussian_vector(config_.noise_ut);
  MagnetometerSample sample;
  sample.t_ns = truth.t_ns;
  sample.field_body_ut = converted(field_body_ut, config_.range_ut, config_.step_ut);
  return sample;
}

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
