#include "sim/sensors/noise.hpp"

#include <algorithm>
#include <cmath>

namespace understory {

double NoiseSource::gaussian(double sigma) { return sigma * unit_(generator_); }

Eigen::Vector3d NoiseSource::gaussian_vector(double sigma) {
  Eigen::Vector3d drawn;
  for (int axis = 0; axis < 3; ++axis) drawn[axis] = gaussian(sigma);  // in a fixed order
  return drawn;
}

std::uint64_t effect_seed(std::uint64_t sensor_seed, std::uint64_t effect) {
  // splitmix64's step and finaliser (Steele, Lea & Flood 2014)
  std::uint64_t mixed = sensor_seed + effect * 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
  return mixed ^ (mixed >> 31);
}

GaussMarkov::GaussMarkov(double sigma, double time_constant_s, NoiseSource& noise)
    : sigma_(sigma), time_constant_s_(time_constant_s), value_(noise.gaussian_vector(sigma)) {}

const Eigen::Vector3d& GaussMarkov::after(double elapsed_s, NoiseSource& noise) {
  if (elapsed_s != elapsed_s_) {
    elapsed_s_ = elapsed_s;
    kept_ = std::exp(-elapsed_s / time_constant_s_);
    added_ = sigma_ * std::sqrt(1 - kept_ * kept_);
  }
  value_ = kept_ * value_ + noise.gaussian_vector(added_);
  return value_;
}

double converted(double value, double range, double step) {
  const double cut = std::clamp(value, -range, range);
  return step > 0 ? step * std::round(cut / step) : cut;
}

Eigen::Vector3d converted(const Eigen::Vector3d& values, double range, double step) {
  return values.unaryExpr([range, step](double value) { return converted(value, range, step); });
}

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
