#include "estimation/airspeed.hpp"

namespace understory {

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config) {
  Measurement<1> measurement;
  measurement.innovation[0] = sample.airspeed_mps - state.velocity_body_mps.x();
  measurement.jacobian(0, velocity_block) = 1;
  measurement.noise(0, 0) = config.sigma_mps * config.sigma_mps;
  return measurement;
}

}  // namespace understory
