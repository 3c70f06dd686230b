#include "estimation/altitude.hpp"

namespace understory {

Measurement<1> altitude(const State& state, const BarometerSample& sample, double offset_m,
                        const AltitudeConfig& config) {
  Measurement<1> measurement;
  measurement.innovation[0] = sample.altitude_m - offset_m - state.T_world_body.translation().z();
  measurement.jacobian(0, position_block + 2) = 1;
  measurement.noise(0, 0) = config.sigma_m * config.sigma_m;
  return measurement;
}

void AltitudeDrift::observe(double excess_m) {
  const double gain = variance_m2_ / (variance_m2_ + config_.noise_m * config_.noise_m);
  value_m_ += gain * (excess_m - value_m_);
  variance_m2_ *= 1 - gain;
}

BarometerOffset::BarometerOffset(double prior_sigma_m, double noise_m)
    : variance_m2_(prior_sigma_m * prior_sigma_m), noise_variance_m2_(noise_m * noise_m) {}

void BarometerOffset::observe(double excess_m) {
  const double gain = variance_m2_ / (variance_m2_ + noise_variance_m2_);
  value_m_ += gain * (excess_m - value_m_);
  variance_m2_ *= 1 - gain;
}

}  // namespace understory
