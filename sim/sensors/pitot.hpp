#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/sensors/noise.hpp"

namespace understory {

/// Pitot tube on a differential pressure sensor of 1 psi (TE/MEAS MS4525DO, total error band 1 % of span
/// before zeroing; 14 bits over +-1 psi). The tube points along body x and measures the dynamic pressure of
/// the air's speed along it. Airspeed is the root of the pressure, so below about 4 to 5 m/s (10 to 15 Pa)
/// noise and bias dominate.
struct PitotConfig {
  double pressure_noise_pa = 1.5;   ///< rms per sample
  double pressure_bias_pa = 1.0;    ///< sigma of the bias that remains after zeroing on the ground
  double pressure_range_pa = 6894;  ///< 1 psi
  double pressure_step_pa = 1.05;   ///< 13107 counts (80 % of 14 bits) over the two-sided range
  double bias_mps = 0.0;            ///< an extra constant error of the airspeed, for experiments
  double dead_zone_pa = 0;          ///< smaller pressures read zero, as drivers do against false wind
  /// Angle between air and tube up to which the reading is correct. Total-pressure tubes keep within 1 % up
  /// to about 10 to 25 deg, by the shape of the nose (Gracey, Letko & Russell 1951, NACA TN 2331).
  double recovery_angle_rad = 0.26;
  /// Share of the pressure lost per square radian beyond that angle; 2: a quarter is gone 20 deg on
  /// (typical). Zero: no loss.
  double recovery_loss = 0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, PitotConfig& config) {
  visit("pressure_noise_pa", config.pressure_noise_pa, 0.0, 1000.0);
  visit("pressure_bias_pa", config.pressure_bias_pa, 0.0, 1000.0);
  visit("pressure_range_pa", config.pressure_range_pa, 10.0, 100000.0);
  visit("pressure_step_pa", config.pressure_step_pa, 0.0, 100.0);
  visit("bias_mps", config.bias_mps, -20.0, 20.0);
  visit("dead_zone_pa", config.dead_zone_pa, 0.0, 1000.0);
  visit("recovery_angle_rad", config.recovery_angle_rad, 0.0, 1.58);
  visit("recovery_loss", config.recovery_loss, 0.0, 100.0);
}

class Pitot {
 public:
  /// The density converts speed into pressure and back, so without errors the reading is the true airspeed.
  Pitot(const PitotConfig& config, double air_density_kgpm3, std::uint64_t seed);
  PitotSample measure(const Truth& truth);

 private:
  PitotConfig config_;
  double air_density_kgpm3_;
  NoiseSource noise_;
  double pressure_bias_pa_;
};

}  // namespace understory
