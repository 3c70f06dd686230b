#include "estimation/measurements.hpp"

namespace understory {

Measurement<1> altitude(const State& state, const BarometerSample& sample, const AltitudeConfig& config) {
  Measurement<1> measurement;
  measurement.innovation[0] =
      sample.altitude_m - state.barometer_offset_m - state.T_world_body.translation().z();
  measurement.jacobian(0, position_block + 2) = 1;
  measurement.jacobian(0, barometer_offset_block) = 1;
  measurement.noise(0, 0) = config.sigma_m * config.sigma_m;
  return measurement;
}

void AltitudeDrift::observe(double excess_m) {
  const double gain = variance_m2_ / (variance_m2_ + config_.noise_m * config_.noise_m);
  value_m_ += gain * (excess_m - value_m_);
  variance_m2_ *= 1 - gain;
}

}  // namespace understory
