#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <vector>

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

/// How a bias changes during a run, in terms of the Allan deviation: a floor (flicker noise, the "in-run bias
/// stability" of data sheets), and a random walk, which raises the curve at long times.
///
/// Flicker noise is approximated by the sum of six first-order Gauss-Markov processes, whose time constants
/// are a decade apart, 0.1 s to 10,000 s. Their Allan deviation is flat within 2.5 % from 1 s to 3,000 s.
/// Each has the deviation floor * sqrt(ln 10 / (2 ln 2)): a decade of 1/f noise of spectrum B^2 / (2 pi f)
/// holds B^2 ln 10 / pi of variance, and the floor is B * sqrt(2 ln 2 / pi) = 0.664 B (IEEE Std 952-1997,
/// annex C).
class BiasWander {
 public:
  /// `floor` in the sensor's unit, `random_walk` in that unit per square root of a second (IEEE's K). A part
  /// that is zero draws no random number. The flicker starts in its stationary distribution, the walk at
  /// zero.
  BiasWander(double floor, double random_walk, std::uint64_t seed);
  /// The bias at a moment; moments must not go backwards.
  Eigen::Vector3d at(std::int64_t t_ns);

 private:
  NoiseSource noise_;
  double random_walk_;
  std::vector<GaussMarkov> flicker_;
  Eigen::Vector3d walked_ = Eigen::Vector3d::Zero();
  std::int64_t last_t_ns_ = -1;
};

}  // namespace understory
