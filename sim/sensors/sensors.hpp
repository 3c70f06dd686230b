#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/sensors/noise.hpp"
#include "sim/sensors/sensors_config.hpp"

namespace understory {

/// Every sensor draws its constant errors for the flight from its seed when it is built. Then it returns one
/// sample for each truth. The same seed and truths give the same samples.
class Imu {
 public:
  Imu(const ImuConfig& config, std::uint64_t seed);
  ImuSample measure(const Truth& truth);
  /// From now on other noise; the constant errors stay. The other sensors have the same.
  void redraw(std::uint64_t seed) { noise_ = NoiseSource(seed); }
  /// The constant errors of the flight, for scoring; wandering errors are added to them.
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

class Pitot {
 public:
  /// The density converts speed into pressure and back, so without errors the reading is the true airspeed.
  Pitot(const PitotConfig& config, double air_density_kgpm3, std::uint64_t seed);
  PitotSample measure(const Truth& truth);
  void redraw(std::uint64_t seed) { noise_ = NoiseSource(seed); }

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
  void redraw(std::uint64_t seed) { noise_ = NoiseSource(seed); }

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
  void redraw(std::uint64_t seed) { noise_ = NoiseSource(seed); }

 private:
  MagnetometerConfig config_;
  NoiseSource noise_;
  Eigen::Vector3d hard_iron_body_ut_;
  Eigen::Matrix3d soft_iron_;
};

class Gps {
 public:
  Gps(const GpsConfig& config, std::uint64_t seed);
  /// A fix of this moment. The caller delivers it delay_s later.
  GpsSample measure(const Truth& truth);
  void redraw(std::uint64_t seed) { noise_ = NoiseSource(seed); }

 private:
  GpsConfig config_;
  NoiseSource noise_;
  GaussMarkov drift_;
  std::int64_t last_t_ns_ = -1;
};

}  // namespace understory
