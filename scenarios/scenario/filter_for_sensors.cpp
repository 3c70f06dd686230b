#include "scenarios/scenario/filter_for_sensors.hpp"

#include <cmath>

namespace understory {

FilterConfig filter_for_sensors(FilterConfig filter, const SensorsConfig& sensors) {
  const SensorsConfig nominal;
  const ImuConfig& imu = sensors.imu;
  const double gyro_noise = imu.gyro_noise_radps / nominal.imu.gyro_noise_radps;
  filter.gyro_noise_radps_rthz *= gyro_noise;
  filter.gyro_scale = std::hypot(imu.gyro_scale, imu.gyro_misalignment);
  const double gyro_bias = imu.gyro_bias_radps / nominal.imu.gyro_bias_radps;
  filter.start.gyro_bias_sigma_radps *= gyro_bias;

  const double force_noise = imu.accelerometer_noise_mps2 / nominal.imu.accelerometer_noise_mps2;
  filter.accelerometer_noise_mps2_rthz *= force_noise;
  filter.accelerometer_scale = std::hypot(imu.accelerometer_scale, imu.accelerometer_misalignment);
  const double force_bias = imu.accelerometer_bias_mps2 / nominal.imu.accelerometer_bias_mps2;
  // What gravity puts on the two level axes is a bias, too.
  double& bias_sigma = filter.states.accelerometer_bias_sigma_mps2;
  bias_sigma = std::hypot(bias_sigma * force_bias, imu.accelerometer_misalignment * filter.gravity_mps2);
  filter.sideslip.sigma_mps2 *= force_noise;
  filter.vibration_mps2pn = imu.accelerometer_vibration_mps2pn;
  if (filter.vibration_mps2pn > 0)
    filter.force_samples = 10;  // 0.05 s: four turns of the propeller in cruise

  RestConfig& rest = filter.rest;
  rest.force_sigma_mps2 *= force_noise;
  rest.force_deviation_mps2 *= force_noise;
  rest.rate_deviation_radps *= gyro_noise;
  rest.rate_tolerance_radps *= gyro_bias;
  rest.accelerometer_bias_mps2 *= force_bias;
  rest.force_tolerance_mps2 =
      std::hypot(rest.force_tolerance_mps2 * force_bias, 3 * imu.accelerometer_scale * filter.gravity_mps2);

  filter.airspeed.sigma_mps *= sensors.pitot.pressure_noise_pa / nominal.pitot.pressure_noise_pa;
  filter.states.pitot_bias_sigma_mps *= sensors.pitot.pressure_bias_pa / nominal.pitot.pressure_bias_pa;

  AltitudeConfig& altitude = filter.altitude;
  const double barometer_noise = sensors.barometer.noise_m / nominal.barometer.noise_m;
  altitude.sigma_m *= barometer_noise;
  altitude.noise_m *= barometer_noise;
  altitude.offset_sigma_m *= barometer_noise;
  altitude.offset_walk_m_rts *= sensors.barometer.drift_m / nominal.barometer.drift_m;
  altitude.wash_sigma_m_per_n = sensors.barometer.wash_m_per_n;
  altitude.drift_walk_m_rts *= force_bias;

  filter.heading.sigma_rad *= sensors.magnetometer.hard_iron_ut / nominal.magnetometer.hard_iron_ut;
  filter.gps.sigma_mps *= sensors.gps.velocity_noise_mps / nominal.gps.velocity_noise_mps;
  return filter;
}

}  // namespace understory
