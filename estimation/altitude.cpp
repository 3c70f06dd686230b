#include "estimation/measurements.hpp"

namespace understory {

double barometer_excess_m(const State& state, double thrust_n) {
  return state.barometer_offset_m + state.barometer_wash_m_per_n * thrust_n;
}

Measurement<1> altitude(const State& state, const BarometerSample& sample, double thrust_n,
                        const AltitudeConfig& config) {
  Measurement<1> measurement;
  measurement.innovation[0] =
      sample.altitude_m - barometer_excess_m(state, thrust_n) - state.T_world_body.translation().z();
  measurement.jacobian(0, position_block + 2) = 1;
  measurement.jacobian(0, barometer_offset_block) = 1;
  measurement.jacobian(0, barometer_wash_block) = thrust_n;
  measurement.noise(0, 0) = config.sigma_m * config.sigma_m;
  return measurement;
}

void AltitudeDrift::observe(double excess_m) {
  const double gain = variance_m2_ / (variance_m2_ + config_.noise_m * config_.noise_m);
  value_m_ += gain * (excess_m - value_m_);
  variance_m2_ *= 1 - gain;
}

}  // namespace understory
