#include "estimation/airspeed.hpp"

#include <algorithm>

#include "estimation/air_velocity.hpp"

namespace understory {

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config) {
  const AirVelocity air = air_velocity(state);
  Measurement<1> measurement;
  measurement.innovation[0] = sample.airspeed_mps - state.pitot_bias_mps - air.body_mps.x();
  measurement.jacobian = air.jacobian.row(0);
  measurement.jacobian(0, pitot_bias_block) = 1;
  constexpr double reference_mps = 12;
  const double sigma_mps = config.sigma_mps * reference_mps / std::max(air.body_mps.x(), config.usable_mps);
  measurement.noise(0, 0) = sigma_mps * sigma_mps;
  return measurement;
}

}  // namespace understory
