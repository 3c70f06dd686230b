#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/sensors/noise.hpp"

namespace understory {

/// Magnetometer (Honeywell HMC5883L: 0.2 uT rms at best, 0.073 uT a count at its standard gain, +-130 uT)
/// near a motor: 0.5 uT of noise and of hard iron left after calibration. The field is that of northern
/// mid-latitudes, towards world +y and down.
struct MagnetometerConfig {
  double field_ut = 48.0;            ///< strength
  double inclination_rad = 1.16937;  ///< 67 deg below the horizon
  double noise_ut = 0.5;             ///< rms per axis and sample
  double hard_iron_ut = 0.5;         ///< sigma of the constant error, per axis
  /// Sigma of the six numbers of the symmetric matrix by which iron on board distorts the field: soft iron
  /// and scale, as shares of the field.
  double soft_iron = 0;
  double range_ut = 130.0;
  double step_ut = 0.073;
};

template <typename Visitor>
void visit_fields(Visitor& visit, MagnetometerConfig& config) {
  visit("field_ut", config.field_ut, 10.0, 100.0);
  visit("inclination_rad", config.inclination_rad, -1.58, 1.58);
  visit("noise_ut", config.noise_ut, 0.0, 100.0);
  visit("hard_iron_ut", config.hard_iron_ut, 0.0, 100.0);
  visit("soft_iron", config.soft_iron, 0.0, 0.5);
  visit("range_ut", config.range_ut, 10.0, 10000.0);
  visit("step_ut", config.step_ut, 0.0, 10.0);
}

class Magnetometer {
 public:
  Magnetometer(const MagnetometerConfig& config, std::uint64_t seed);
  MagnetometerSample measure(const Truth& truth);

 private:
  MagnetometerConfig config_;
  NoiseSource noise_;
  Eigen::Vector3d hard_iron_body_ut_;
  Eigen::Matrix3d soft_iron_;
};

}  // namespace understory
