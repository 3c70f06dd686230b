#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/sensors/bias_wander.hpp"
#include "sim/sensors/noise.hpp"

namespace understory {

/// Six-axis IMU of the consumer class (InvenSense MPU-6000 product specification 3.4, ICM-20602 1.0). A
/// sample is the truth of its physics step plus errors. No internal filter is modelled, so the noise per
/// sample is that after the sensor's low-pass. Readings saturate at the range and are rounded to the
/// resolution. Effects at zero are off; the grade `consumer` sets those of a real part
/// (sim/sensors/sensor_grades.hpp, docs/sensors.md).
struct ImuConfig {
  double gyro_noise_radps = 0.0024;  ///< rms per sample, 0.14 deg/s: 0.01 deg/s/sqrt(Hz) over 200 Hz
  double gyro_bias_radps = 0.0087;   ///< sigma of the constant bias, 0.5 deg/s: remains after a start at rest
  double gyro_bias_instability_radps = 0;  ///< floor of the Allan deviation: sim/sensors/bias_wander.hpp
  double gyro_walk_radpsps_rthz = 0;       ///< rate random walk, rad/s per root second (IEEE 952's K)
  double gyro_scale = 0;                   ///< sigma of the constant scale error per axis, 0.01: one per cent
  double gyro_misalignment =
      0;  ///< sigma per pair of axes: share of one axis that appears on the other (rad)
  double gyro_vibration_radpspn = 0;               ///< amplitude per newton of thrust
  double gyro_range_radps = 17.4533;               ///< 1000 deg/s
  double gyro_step_radps = 0.000532;               ///< 16 bits over the range: 32.8 counts per deg/s
  double accelerometer_noise_mps2 = 0.05;          ///< rms per sample: 400 ug/sqrt(Hz) over 200 Hz is 0.055
  double accelerometer_bias_mps2 = 0.05;           ///< sigma of the constant bias after calibration (5 mg)
  double accelerometer_bias_instability_mps2 = 0;  ///< floor of the Allan deviation
  double accelerometer_walk_mps2ps_rthz = 0;       ///< acceleration random walk, m/s^2 per root second
  double accelerometer_scale = 0;                  ///< as the gyro's
  double accelerometer_misalignment = 0;           ///< as the gyro's
  double accelerometer_vibration_mps2pn = 0;       ///< amplitude per newton of thrust
  double accelerometer_range_mps2 = 156.9;         ///< 16 g: the catapult's 5 g stays inside
  double accelerometer_step_mps2 = 0.00479;        ///< 2048 counts per g
  /// Turns a second at 1 N of thrust; a propeller's thrust grows with their square. 1 / (D^2 sqrt(C_T rho))
  /// with an 8 inch propeller (0.203 m) and a thrust coefficient of 0.1 (typical).
  double propeller_hz_at_1n = 70;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ImuConfig& config) {
  visit("gyro_noise_radps", config.gyro_noise_radps, 0.0, 1.0);
  visit("gyro_bias_radps", config.gyro_bias_radps, 0.0, 1.0);
  visit("gyro_bias_instability_radps", config.gyro_bias_instability_radps, 0.0, 0.1);
  visit("gyro_walk_radpsps_rthz", config.gyro_walk_radpsps_rthz, 0.0, 0.1);
  visit("gyro_scale", config.gyro_scale, 0.0, 0.3);
  visit("gyro_misalignment", config.gyro_misalignment, 0.0, 0.3);
  visit("gyro_vibration_radpspn", config.gyro_vibration_radpspn, 0.0, 10.0);
  visit("gyro_range_radps", config.gyro_range_radps, 0.1, 100.0);
  visit("gyro_step_radps", config.gyro_step_radps, 0.0, 0.1);
  visit("accelerometer_noise_mps2", config.accelerometer_noise_mps2, 0.0, 10.0);
  visit("accelerometer_bias_mps2", config.accelerometer_bias_mps2, 0.0, 10.0);
  visit("accelerometer_bias_instability_mps2", config.accelerometer_bias_instability_mps2, 0.0, 1.0);
  visit("accelerometer_walk_mps2ps_rthz", config.accelerometer_walk_mps2ps_rthz, 0.0, 1.0);
  visit("accelerometer_scale", config.accelerometer_scale, 0.0, 0.3);
  visit("accelerometer_misalignment", config.accelerometer_misalignment, 0.0, 0.3);
  visit("accelerometer_vibration_mps2pn", config.accelerometer_vibration_mps2pn, 0.0, 100.0);
  visit("accelerometer_range_mps2", config.accelerometer_range_mps2, 10.0, 1000.0);
  visit("accelerometer_step_mps2", config.accelerometer_step_mps2, 0.0, 1.0);
  visit("propeller_hz_at_1n", config.propeller_hz_at_1n, 1.0, 1000.0);
}

/// Every sensor draws the constants of the flight from its seed when it is built. Then it returns one sample
/// for each truth. The same seed and truths give the same samples.
class Imu {
 public:
  Imu(const ImuConfig& config, std::uint64_t seed);
  ImuSample measure(const Truth& truth);
  /// The constants of the flight, for scoring; wandering errors come on top.
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_radps_; }
  const Eigen::Vector3d& accelerometer_bias_mps2() const { return accelerometer_bias_mps2_; }

 private:
  /// The force of the propeller's imbalance. It grows with the thrust (N) and rotates in the plane across the
  /// shaft, body y and z.
  Eigen::Vector3d shake(const Truth& truth);

  ImuConfig config_;
  NoiseSource noise_;
  Eigen::Vector3d gyro_bias_radps_;
  Eigen::Vector3d accelerometer_bias_mps2_;
  Eigen::Matrix3d gyro_gain_;  ///< scale on the diagonal, misalignment elsewhere
  Eigen::Matrix3d accelerometer_gain_;
  BiasWander gyro_wander_;
  BiasWander accelerometer_wander_;
  double propeller_turns_ = 0;
  std::int64_t last_t_ns_ = -1;
};

}  // namespace understory
