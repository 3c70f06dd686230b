#pragma once

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// Velocity over ground from GPS, measured at an earlier moment. The inertial sensors alone say how the
/// velocity has changed since, so that corrections made meanwhile are not applied twice.
struct GroundVelocityConfig {
  bool enabled = true;     ///< whether samples, where there are any, are used
  double sigma_mps = 0.2;  ///< m/s, 0.01..10, per axis (docs/sources.md [15])
};

template <typename Visitor>
void visit_fields(Visitor& visit, GroundVelocityConfig& config) {
  visit("enabled", config.enabled);
  visit("sigma_mps", config.sigma_mps, 0.01, 10.0);
}

/// `then` is the estimate recorded for the sample's moment.
Measurement<3> ground_velocity(const State& now, const State& then, const GpsSample& sample,
                               const GroundVelocityConfig& config);

/// How far the aircraft moved between two moments, according to an obstacle seen at two depths. The present
/// velocity, carried back by the inertial sensors, must have covered that distance. Level, world axes. The
/// two estimates are those recorded for the sample's two moments.
Measurement<2> ground_displacement(const State& now, const State& earlier, const State& later,
                                   const ResightingSample& sample);

}  // namespace understory
