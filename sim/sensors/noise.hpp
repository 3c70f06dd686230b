#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace understory {

/// White Gaussian noise from a generator of its own.
class NoiseSource {
 public:
  explicit NoiseSource(std::uint64_t seed) : generator_(seed) {}
  double gaussian(double sigma);
  Eigen::Vector3d gaussian_vector(double sigma);

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> unit_;
};

/// A seed for one effect of a sensor, so that switching the effect on or off changes no other draw. `effect`:
/// its number within the sensor, from 1.
std::uint64_t effect_seed(std::uint64_t sensor_seed, std::uint64_t effect);

/// First-order Gauss-Markov process: white noise through a low-pass, with a stationary standard deviation and
/// a time constant. Exact for any time steps.
class GaussMarkov {
 public:
  /// Starts in its stationary distribution.
  GaussMarkov(double sigma, double time_constant_s, NoiseSource& noise);
  /// The value `elapsed_s` after the last one.
  const Eigen::Vector3d& after(double elapsed_s, NoiseSource& noise);
  const Eigen::Vector3d& value() const { return value_; }

 private:
  double sigma_;
  double time_constant_s_;
  Eigen::Vector3d value_;
  double elapsed_s_ =
      -1;  ///< for which the two factors below hold: most steps are equal, and an exponential is expensive
  double kept_ = 1;
  double added_ = 0;
};

/// Limited to the range, then rounded to the converter's step. A step of zero leaves the value as it is.
double converted(double value, double range, double step);
Eigen::Vector3d converted(const Eigen::Vector3d& values, double range, double step);

}  // namespace understory
