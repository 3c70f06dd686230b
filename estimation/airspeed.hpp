#pragma once

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// The pitot tube measures the aircraft's speed through the air along body x, and a bias that zeroing left.
struct AirspeedConfig {
  double usable_mps =
      6.0;  ///< m/s, 0..20: slower readings are ignored (FACTS section 4: poor below flight speed)
  /// m/s, 0.01..10. A 1 psi sensor's 1 to 2 Pa are 0.1 m/s at 12 m/s, half of it a bias that lasts the
  /// flight, so that each of the 50 readings a second counts for less than its noise says.
  double sigma_mps = 0.35;
};

template <typename Visitor>
void visit_fields(Visitor& visit, AirspeedConfig& config) {
  visit("usable_mps", config.usable_mps, 0.0, 20.0);
  visit("sigma_mps", config.sigma_mps, 0.01, 10.0);
}

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config);

}  // namespace understory
