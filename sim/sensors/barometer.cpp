#include "sim/sensors/barometer.hpp"

#include <cmath>

namespace understory {

Barometer::Barometer(const BarometerConfig& config, std::uint64_t seed) : config_(config), noise_(seed) {}

BarometerSample Barometer::measure(const Truth& truth) {
  if (last_t_ns_ >= 0) {
    const double elapsed_s = static_cast<double>(truth.t_ns - last_t_ns_) * 1e-9;
    const double kept = std::exp(-elapsed_s / config_.drift_time_s);
    offset_m_ = kept * offset_m_ + noise_.gaussian(config_.drift_m * std::sqrt(1 - kept * kept));
  }
  last_t_ns_ = truth.t_ns;
  constexpr double highest_m = 10000;
  BarometerSample sample;
  sample.t_ns = truth.t_ns;
  sample.altitude_m = converted(truth.T_world_body.translation().z() + offset_m_ +
                                    config_.wash_m_per_n * truth.thrust_n + noise_.gaussian(config_.noise_m),
                                highest_m, config_.step_m);
  return sample;
}

}  // namespace understory
