#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/sensors/noise.hpp"

namespace understory {

/// Barometer (MEAS MS5611-01BA03: 0.012 to 0.065 mbar rms, a count is about 10 cm) read in the slipstream:
/// 0.3 m of noise, and an offset that wanders as a first-order Gauss-Markov process, zero at the first
/// sample.
struct BarometerConfig {
  double noise_m = 0.3;        ///< rms per sample
  double step_m = 0.1;         ///< resolution
  double drift_m = 0.5;        ///< stationary sigma of the wandering offset
  double drift_time_s = 60.0;  ///< its time constant: weather, heat, airframe pressure
  /// Altitude error from the propeller's wash, per newton of thrust. An 8 inch propeller's disc (0.032 m^2)
  /// raises the dynamic pressure by 31 Pa per newton, 2.6 m of altitude (momentum theory); a port inside the
  /// fuselage feels a part of it, here a tenth (typical), and reads too high.
  double wash_m_per_n = 0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, BarometerConfig& config) {
  visit("noise_m", config.noise_m, 0.0, 20.0);
  visit("step_m", config.step_m, 0.0, 10.0);
  visit("drift_m", config.drift_m, 0.0, 50.0);
  visit("drift_time_s", config.drift_time_s, 0.1, 10000.0);
  visit("wash_m_per_n", config.wash_m_per_n, -10.0, 10.0);
}

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

}  // namespace understory
