#pragma once

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// The barometer measures world z. Its offset is read on the catapult, where the altitude is known.
struct AltitudeConfig {
  /// m, 0.01..100. Noise is 0.3 m; a slow error of 0.2 m comes on top and does not average out, and the gains
  /// must stay small for the map's sake.
  double sigma_m = 2.0;
  double offset_sigma_m = 0.3;    ///< m, 0..10: spread of the offset before the readings at rest
  double noise_m = 0.3;           ///< m, 0.01..100: of one reading about its slow error (consumer barometer)
  double drift_walk_m_rts = 0.1;  ///< m/sqrt(s), 0..10: how fast odometry and altitude may part
};

template <typename Visitor>
void visit_fields(Visitor& visit, AltitudeConfig& config) {
  visit("sigma_m", config.sigma_m, 0.01, 100.0);
  visit("offset_sigma_m", config.offset_sigma_m, 0.0, 10.0);
  visit("noise_m", config.noise_m, 0.01, 100.0);
  visit("drift_walk_m_rts", config.drift_walk_m_rts, 0.0, 10.0);
}

/// The height of the odometry frame's zero over the ground, followed slowly from the barometer: the
/// odometry's z itself is moved by no correction. A scalar Kalman filter of a random walk.
class AltitudeDrift {
 public:
  explicit AltitudeDrift(const AltitudeConfig& config) : config_(config) {}
  void pass(double dt_s) { variance_m2_ += config_.drift_walk_m_rts * config_.drift_walk_m_rts * dt_s; }
  /// `excess_m`: the barometer's altitude, offset taken out, less the odometry's z.
  void observe(double excess_m);
  double value_m() const { return value_m_; }

 private:
  AltitudeConfig config_;
  double value_m_ = 0;
  double variance_m2_ = 0;
};

/// `offset_m` is what the barometer reads too much.
Measurement<1> altitude(const State& state, const BarometerSample& sample, double offset_m,
                        const AltitudeConfig& config);

/// The barometer's offset: the mean of what it read at rest over the known altitude, shrunk by the prior.
class BarometerOffset {
 public:
  /// `noise_m`: standard deviation of one reading about its slow error (consumer barometer: 0.3 m).
  explicit BarometerOffset(double prior_sigma_m, double noise_m = 0.3);
  void observe(double excess_m);
  double value_m() const { return value_m_; }

 private:
  double variance_m2_;
  double noise_variance_m2_;
  double value_m_ = 0;
};

}  // namespace understory
