#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/sensors/noise.hpp"

namespace understory {

/// Satellite receiver of the consumer class (u-blox M8: 2.5 m circular error of position, 0.05 m/s of
/// velocity at best; 5 Hz, 0.2 s late and 0.2 m/s among trees on an aircraft that turns). Most of the
/// position's error wanders with satellites and reflections: a first-order Gauss-Markov process that starts
/// in its stationary distribution. Across a forest it is nearly constant.
struct GpsConfig {
  bool enabled = false;               ///< off: the original's avoidance used no GPS
  double delay_s = 0.2;               ///< from the moment of measurement to the arrival
  double velocity_noise_mps = 0.2;    ///< rms per axis and fix
  double position_noise_m = 0.3;      ///< rms per axis and fix, the part that is new with every fix (typical)
  double position_drift_m = 2.1;      ///< sigma per horizontal axis of the wandering part: 2.5 m / 1.18
  double position_drift_time_s = 60;  ///< its time constant (typical)
  double vertical_factor = 1.5;  ///< height errors are larger by this factor: no satellites below (typical)
};

template <typename Visitor>
void visit_fields(Visitor& visit, GpsConfig& config) {
  visit("enabled", config.enabled);
  visit("delay_s", config.delay_s, 0.0, 2.0);
  visit("velocity_noise_mps", config.velocity_noise_mps, 0.0, 20.0);
  visit("position_noise_m", config.position_noise_m, 0.0, 100.0);
  visit("position_drift_m", config.position_drift_m, 0.0, 100.0);
  visit("position_drift_time_s", config.position_drift_time_s, 0.1, 10000.0);
  visit("vertical_factor", config.vertical_factor, 1.0, 10.0);
}

class Gps {
 public:
  Gps(const GpsConfig& config, std::uint64_t seed);
  /// A fix of this moment. The caller delivers it delay_s later.
  GpsSample measure(const Truth& truth);

 private:
  GpsConfig config_;
  NoiseSource noise_;
  GaussMarkov drift_;
  std::int64_t last_t_ns_ = -1;
};

}  // namespace understory
