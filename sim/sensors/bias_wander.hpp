#pragma once

#include <cstdint>
#include <vector>

#include "sim/sensors/noise.hpp"

namespace understory {

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
