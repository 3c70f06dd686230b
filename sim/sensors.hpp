#pragma once

#include <cstdint>
#include <random>

#include "estimation/samples.hpp"
#include "sim/truth.hpp"

namespace understory {

/// Whether a sensor of this rate falls on whole physics steps (1200 Hz), as every rate of a scenario must.
bool divides_physics_rate(int rate_hz);

/// Six-axis IMU of the consumer class (InvenSense MPU-6000 product specification 3.4, ICM-20602 1.0).
/// A sample is the truth of its physics step plus noise: no internal filter is modelled, so the noise per
/// sample is that of the sensor's own low-pass. Saturates at the range, steps by the resolution.
struct ImuConfig {
  double gyro_noise_radps = 0.0024;  ///< rms per sample, 0.14 deg/s: 0.01 deg/s/sqrt(Hz) over 200 Hz
  double gyro_bias_radps =
      0.0087;  ///< sigma of the flight's constant, 0.5 deg/s: what a still start leaves over
  double gyro_range_radps = 17.4533;         ///< 1000 deg/s
  double gyro_step_radps = 0.000532;         ///< 16 bits over the range: 32.8 counts per deg/s
  double accelerometer_noise_mps2 = 0.05;    ///< rms per sample: 400 ug/sqrt(Hz) over 200 Hz is 0.055
  double accelerometer_bias_mps2 = 0.05;     ///< sigma of the flight's constant, after calibration (5 mg)
  double accelerometer_range_mps2 = 156.9;   ///< 16 g: the catapult's 5 g stays inside
  double accelerometer_step_mps2 = 0.00479;  ///< 2048 counts per g
};

template <typename Visitor>
void visit_fields(Visitor& visit, ImuConfig& config) {
  visit("gyro_noise_radps", config.gyro_noise_radps, 0.0, 1.0);
  visit("gyro_bias_radps", config.gyro_bias_radps, 0.0, 1.0);
  visit("gyro_range_radps", config.gyro_range_radps, 0.1, 100.0);
  visit("gyro_step_radps", config.gyro_step_radps, 0.0, 0.1);
  visit("accelerometer_noise_mps2", config.accelerometer_noise_mps2, 0.0, 10.0);
  visit("accelerometer_bias_mps2", config.accelerometer_bias_mps2, 0.0, 10.0);
  visit("accelerometer_range_mps2", config.accelerometer_range_mps2, 10.0, 1000.0);
  visit("accelerometer_step_mps2", config.accelerometer_step_mps2, 0.0, 1.0);
}

/// Pitot tube on a differential pressure sensor of 1 psi (TE/MEAS MS4525DO, total error band 1 % of span
/// before zeroing; 14 bits over +-1 psi). The tube looks along body x. Airspeed comes from the root of the
/// pressure, so below about 4 to 5 m/s (10 to 15 Pa) noise and bias drown it.
struct PitotConfig {
  double pressure_noise_pa = 1.5;   ///< rms per sample
  double pressure_bias_pa = 1.0;    ///< sigma of what zeroing on the ground leaves over
  double pressure_range_pa = 6894;  ///< 1 psi
  double pressure_step_pa = 1.05;   ///< 13107 counts (80 % of 14 bits) over the two-sided range
  double bias_mps = 0.0;            ///< an extra constant error of the airspeed, for experiments
};

template <typename Visitor>
void visit_fields(Visitor& visit, PitotConfig& config) {
  visit("pressure_noise_pa", config.pressure_noise_pa, 0.0, 1000.0);
  visit("pressure_bias_pa", config.pressure_bias_pa, 0.0, 1000.0);
  visit("pressure_range_pa", config.pressure_range_pa, 10.0, 100000.0);
  visit("pressure_step_pa", config.pressure_step_pa, 0.0, 100.0);
  visit("bias_mps", config.bias_mps, -20.0, 20.0);
}

/// Barometer (MEAS MS5611-01BA03: 0.012 to 0.065 mbar rms, a count is about 10 cm) read in the slipstream:
/// 0.3 m of noise, and an offset that wanders as a first-order Gauss-Markov process, zero at the first
/// sample.
struct BarometerConfig {
  double noise_m = 0.3;        ///< rms per sample
  double step_m = 0.1;         ///< resolution
  double drift_m = 0.5;        ///< sigma that the wandering offset tends to
  double drift_time_s = 60.0;  ///< its time constant: weather, heat, airframe pressure
};

template <typename Visitor>
void visit_fields(Visitor& visit, BarometerConfig& config) {
  visit("noise_m", config.noise_m, 0.0, 20.0);
  visit("step_m", config.step_m, 0.0, 10.0);
  visit("drift_m", config.drift_m, 0.0, 50.0);
  visit("drift_time_s", config.drift_time_s, 0.1, 10000.0);
}

/// Magnetometer (Honeywell HMC5883L: 0.2 uT rms at best, 0.073 uT a count at its standard gain, +-130 uT)
/// near a motor: 0.5 uT of noise and of hard iron left after calibration. The field is that of northern
/// mid-latitudes, towards world +y and down.
struct MagnetometerConfig {
  double field_ut = 48.0;            ///< strength
  double inclination_rad = 1.16937;  ///< 67 deg below the horizon
  double noise_ut = 0.5;             ///< rms per axis and sample
  double hard_iron_ut = 0.5;         ///< sigma of the flight's constant, per axis
  double range_ut = 130.0;
  double step_ut = 0.073;
};

template <typename Visitor>
void visit_fields(Visitor& visit, MagnetometerConfig& config) {
  visit("field_ut", config.field_ut, 10.0, 100.0);
  visit("inclination_rad", config.inclination_rad, -1.58, 1.58);
  visit("noise_ut", config.noise_ut, 0.0, 100.0);
  visit("hard_iron_ut", config.hard_iron_ut, 0.0, 100.0);
  visit("range_ut", config.range_ut, 10.0, 10000.0);
  visit("step_ut", config.step_ut, 0.0, 10.0);
}

/// Rates must divide 1200 Hz (divides_physics_rate; whoever loads a scenario checks).
struct SensorsConfig {
  int imu_rate_hz = 200;
  int pitot_rate_hz = 50;
  int barometer_rate_hz = 50;
  int magnetometer_rate_hz = 50;
  ImuConfig imu;
  PitotConfig pitot;
  BarometerConfig barometer;
  MagnetometerConfig magnetometer;
};

template <typename Visitor>
void visit_fields(Visitor& visit, SensorsConfig& config) {
  visit("imu_rate_hz", config.imu_rate_hz, 1, 1200);
  visit("pitot_rate_hz", config.pitot_rate_hz, 1, 1200);
  visit("barometer_rate_hz", config.barometer_rate_hz, 1, 1200);
  visit("magnetometer_rate_hz", config.magnetometer_rate_hz, 1, 1200);
  visit("imu", config.imu);
  visit("pitot", config.pitot);
  visit("barometer", config.barometer);
  visit("magnetometer", config.magnetometer);
}

/// White Gaussian noise from a generator of its own.
class NoiseSource {
 public:
  explicit NoiseSource(std::uint64_t seed) : generator_(seed) {}
  double gaussian(double sigma);
  Eigen::Vector3d gaussian_vector(double sigma);

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> unit_;
};

/// Every sensor draws the flight's constants from its seed when it is built, then answers with one sample of
/// the truth it is shown. Same seed and truths: same samples.
class Imu {
 public:
  Imu(const ImuConfig& config, std::uint64_t seed);
  ImuSample measure(const Truth& truth);
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_radps_; }  ///< for scoring

 private:
  ImuConfig config_;
  NoiseSource noise_;
  Eigen::Vector3d gyro_bias_radps_;
  Eigen::Vector3d accelerometer_bias_mps2_;
};

class Pitot {
 public:
  /// The density turns speed into pressure and back; an instrument in still air reads the true airspeed.
  Pitot(const PitotConfig& config, double air_density_kgpm3, std::uint64_t seed);
  PitotSample measure(const Truth& truth);

 private:
  PitotConfig config_;
  double air_density_kgpm3_;
  NoiseSource noise_;
  double pressure_bias_pa_;
};

class Barometer {
 public:
  Barometer(const BarometerConfig& config, std::uint64_t seed);
  BarometerSample measure(const Truth& truth);

 private:
  BarometerConfig config_;
  NoiseSource noise_;
  double offset_m_ = 0;
  std::int64_t last_t_ns_ = -1;
};

class Magnetometer {
 public:
  Magnetometer(const MagnetometerConfig& config, std::uint64_t seed);
  MagnetometerSample measure(const Truth& truth);

 private:
  MagnetometerConfig config_;
  NoiseSource noise_;
  Eigen::Vector3d hard_iron_body_ut_;
};

}  // namespace understory
