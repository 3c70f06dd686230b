#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/aircraft/truth.hpp"
#include "sim/scene/world.hpp"

namespace understory {

/// Level and steady along world x.
inline Truth cruising(double speed_mps = 12, std::int64_t step = 0) {
  Truth truth;
  truth.t_ns = time_of_step_ns(step);
  truth.T_world_body.translation() = Eigen::Vector3d(0, 0, 3);
  truth.velocity_world_mps = Eigen::Vector3d(speed_mps, 0, 0);
  truth.angular_rate_body_radps = Eigen::Vector3d(0.1, -0.2, 0.3);
  truth.specific_force_body_mps2 = Eigen::Vector3d(0, 0, 9.81);
  return truth;
}

struct Statistics {
  double mean = 0;
  double deviation = 0;
};

template <typename Draw>
Statistics statistics(int count, Draw draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double value = draw(i);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

/// Overlapping Allan deviation (IEEE Std 952-1997, annex C) of a rate that came in even samples, averaged
/// over `samples_averaged` of them. `sums[k]`: of the first k samples.
inline double overlapping_allan_deviation(const std::vector<double>& sums, std::size_t samples_averaged) {
  const std::size_t m = samples_averaged;
  double squares = 0;
  for (std::size_t k = 0; k + 2 * m < sums.size(); ++k) {
    const double difference = (sums[k + 2 * m] - sums[k + m]) - (sums[k + m] - sums[k]);
    squares += difference * difference;
  }
  const double count = static_cast<double>(sums.size() - 2 * m);
  return std::sqrt(squares / (2 * count)) / static_cast<double>(m);
}

/// Running sums of three axes, whose Allan deviation is taken as one: the axes are of one kind.
class AllanSeries {
 public:
  template <typename Vector>
  void add(const Vector& reading) {
    for (int axis = 0; axis < 3; ++axis) sums_[axis].push_back(sums_[axis].back() + reading[axis]);
  }
  double deviation(std::size_t samples_averaged) const {
    double variance = 0;
    for (const std::vector<double>& sums : sums_) {
      const double deviation = overlapping_allan_deviation(sums, samples_averaged);
      variance += deviation * deviation / 3;
    }
    return std::sqrt(variance);
  }

 private:
  std::vector<double> sums_[3] = {{0}, {0}, {0}};
};

}  // namespace understory
