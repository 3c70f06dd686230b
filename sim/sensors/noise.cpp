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

}  // namespace understory
