#include "sim/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world.hpp"

namespace understory {
namespace {

/// Cut at the range, then rounded to the converter's steps. A step of zero leaves the value as it is.
double converted(double value, double range, double step) {
  const double cut = std::clamp(value, -range, range);
  return step > 0 ? step * std::round(cut / step) : cut;
}

Eigen::Vector3d converted(const Eigen::Vector3d& values, double range, double step) {
  return values.unaryExpr([range, step](double value) { return converted(value, range, step); });
}

}  // namespace

bool divides_physics_rate(int rate_hz) { return rate_hz > 0 && physics_rate_hz % rate_hz == 0; }

double NoiseSource::gaussian(double sigma) { return sigma * unit_(generator_); }

Eigen::Vector3d NoiseSource::gaussian_vector(double sigma) {
  Eigen::Vector3d drawn;
  for (int axis = 0; axis < 3; ++axis) drawn[axis] = gaussian(sigma);  // in a fixed order
  return drawn;
}

Imu::Imu(const ImuConfig& config, std::uint64_t seed)
    : config_(config),
      noise_(seed),
      gyro_bias_radps_(noise_.gaussian_vector(config.gyro_bias_radps)),
      accelerometer_bias_mps2_(noise_.gaussian_vector(config.accelerometer_bias_mps2)) {}

ImuSample Imu::measure(const Truth& truth) {
  ImuSample sample;
  sample.t_ns = truth.t_ns;
  const Eigen::Vector3d rate =
      truth.angular_rate_body_radps + gyro_bias_radps_ + noise_.gaussian_vector(config_.gyro_noise_radps);
  const Eigen::Vector3d force = truth.specific_force_body_mps2 + accelerometer_bias_mps2_ +
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
  const double pressure_pa = converted(0.5 * air_density_kgpm3_ * forward_mps * forward_mps +
                                           pressure_bias_pa_ + noise_.gaussian(config_.pressure_noise_pa),
                                       config_.pressure_range_pa, config_.pressure_step_pa);
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
  sample.altitude_m =
      converted(truth.T_world_body.translation().z() + offset_m_ + noise_.gaussian(config_.noise_m),
                highest_m, config_.step_m);
  return sample;
}

Magnetometer::Magnetometer(const MagnetometerConfig& config, std::uint64_t seed)
    : config_(config), noise_(seed), hard_iron_body_ut_(noise_.gaussian_vector(config.hard_iron_ut)) {}

MagnetometerSample Magnetometer::measure(const Truth& truth) {
  const Eigen::Vector3d field_world_ut =
      config_.field_ut *
      Eigen::Vector3d(0, std::cos(config_.inclination_rad), -std::sin(config_.inclination_rad));
  const Eigen::Vector3d field_body_ut = truth.T_world_body.linear().transpose() * field_world_ut +
                                        hard_iron_body_ut_ + noise_.gaussian_vector(config_.noise_ut);
  MagnetometerSample sample;
  sample.t_ns = truth.t_ns;
  sample.field_body_ut = converted(field_body_ut, config_.range_ut, config_.step_ut);
  return sample;
}

}  // namespace understory
