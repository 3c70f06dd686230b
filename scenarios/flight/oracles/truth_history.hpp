#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>

#include "sim/aircraft/truth.hpp"

namespace understory {

/// The truth of the last 0.6 s, for the oracles. The flight adds to it at every physics step.
class TruthHistory {
 public:
  void observe(const Truth& truth);
  /// The newest truth not later than t_ns, or the oldest. Asserts that there is one.
  const Truth& at(std::int64_t t_ns) const;

 private:
  std::deque<Truth> moments_;
};

}  // namespace understory
