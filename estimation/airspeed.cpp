#include "estimation/airspeed.hpp"

#include "estimation/air_velocity.hpp"

namespace understory {

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config) {
  const AirVelocity air = air_velocity(state);
  Measurement<1> measurement;
  measurement.innovation[0] = sample.airspeed_mps - state.pitot_bias_mps - air.body_mps.x();
  measurement.jacobian = air.jacobian.row(0);
  measurement.jacobian(0, pitot_bias_block) = 1;
  measurement.noise(0, 0) = config.sigma_mps * config.sigma_mps;
  return measurement;
}

}  // namespace understory
