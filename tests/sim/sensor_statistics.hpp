#pragma once

#include <cmath>
#include <cstdint>

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

}  // namespace understory
