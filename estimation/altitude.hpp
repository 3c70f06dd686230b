#pragma once

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// The barometer measures world z plus an offset. The offset is a state; it is observed on the catapult,
/// where the altitude is known.
struct AltitudeConfig {
  double sigma_m = 0.4;             ///< m, 0.01..100: of one reading; a consumer barometer's noise is 0.3 m
  double offset_sigma_m = 0.3;      ///< m, 0..10: spread of the offset before the readings at rest
  double offset_walk_m_rts = 0.09;  ///< m/sqrt(s), 0..10: weather, heat and wash: 0.5 m in a minute
  double noise_m = 0.3;           ///< m, 0.01..100: of one reading about its slow error (consumer barometer)
  double drift_walk_m_rts = 0.1;  ///< m/sqrt(s), 0..10: how fast odometry and altitude may part
};

template <typename Visitor>
void visit_fields(Visitor& visit, AltitudeConfig& config) {
  visit("sigma_m", config.sigma_m, 0.01, 100.0);
  visit("offset_sigma_m", config.offset_sigma_m, 0.0, 10.0);
  visit("offset_walk_m_rts", config.offset_walk_m_rts, 0.0, 10.0);
  visit("noise_m", config.noise_m, 0.01, 100.0);
  visit("drift_walk_m_rts", config.drift_walk_m_rts, 0.0, 10.0);
}

/// The height of the odometry frame's origin above the ground, followed slowly from the barometer. (No
/// correction moves the odometry's z itself.) A scalar Kalman filter of a random walk.
class AltitudeDrift {
 public:
  explicit AltitudeDrift(const AltitudeConfig& config) : config_(config) {}
  void pass(double dt_s) { variance_m2_ += config_.drift_walk_m_rts * config_.drift_walk_m_rts * dt_s; }
  /// `excess_m`: the barometer's altitude minus its offset minus the odometry's z.
  void observe(double excess_m);
  double value_m() const { return value_m_; }

 private:
  AltitudeConfig config_;
  double value_m_ = 0;
  double variance_m2_ = 0;
};

Measurement<1> altitude(const State& state, const BarometerSample& sample, const AltitudeConfig& config);

}  // namespace understory
