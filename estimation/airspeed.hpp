#pragma once

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// The pitot tube measures the speed through the air along body x, plus a bias that remains after zeroing.
struct AirspeedConfig {
  double usable_mps = 6.0;  ///< m/s, 0..20: slower readings are ignored, being poor
  /// m/s, 0.01..10: of one reading at 12 m/s; pressure grows with the square of the speed, so that slower
  /// readings are worse by as much. 1.5 Pa of noise are 0.11 m/s; the bias is a state.
  double sigma_mps = 0.15;
};

template <typename Visitor>
void visit_fields(Visitor& visit, AirspeedConfig& config) {
  visit("usable_mps", config.usable_mps, 0.0, 20.0);
  visit("sigma_mps", config.sigma_mps, 0.01, 10.0);
}

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config);

}  // namespace understory
