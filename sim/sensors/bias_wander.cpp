#include "sim/sensors/bias_wander.hpp"

#include <cmath>

namespace understory {

BiasWander::BiasWander(double floor, double random_walk, std::uint64_t seed)
    : noise_(seed), random_walk_(random_walk) {
  if (floor <= 0) return;
  const double sigma = floor * std::sqrt(std::log(10.0) / (2 * std::log(2.0)));
  for (const double time_constant_s : {0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0}) {
    flicker_.emplace_back(sigma, time_constant_s, noise_);
  }
}

Eigen::Vector3d BiasWander::at(std::int64_t t_ns) {
  const double elapsed_s = last_t_ns_ < 0 ? 0 : static_cast<double>(t_ns - last_t_ns_) * 1e-9;
  last_t_ns_ = t_ns;
  if (random_walk_ > 0 && elapsed_s > 0) {
    walked_ += noise_.gaussian_vector(random_walk_ * std::sqrt(elapsed_s));
  }
  Eigen::Vector3d bias = walked_;
  for (GaussMarkov& process : flicker_) {
    bias += elapsed_s > 0 ? process.after(elapsed_s, noise_) : process.value();
  }
  return bias;
}

}  // namespace understory
