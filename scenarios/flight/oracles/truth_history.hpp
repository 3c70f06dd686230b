#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>

#include "sim/aircraft/truth.hpp"

namespace understory {

/// What was true in the last moments, for the oracles that stand in for vision or filter. The loop feeds it
/// every physics step; it keeps 0.6 s.
class TruthHistory {
 public:
  void observe(const Truth& truth);
  /// The newest truth not later than t_ns; the oldest kept where t_ns lies before it. Asserts that any was
  /// observed.
  const Truth& at(std::int64_t t_ns) const;

 private:
  std::deque<Truth> moments_;
};

}  // namespace understory
