#pragma once

#include <cstdint>

#include "estimation/state.hpp"
#include "planning/airframe.hpp"

namespace understory {

/// Gives the controls in place of planner and path follower: a person, a program of one's own, a table.
class Pilot {
 public:
  virtual ~Pilot() = default;
  /// The controls from t_ns on, until the next call one control step later. Elevons and thrust must lie
  /// within the airframe's limits. It is not called on the catapult: surfaces are neutral there.
  virtual Controls controls(std::int64_t t_ns, const State& state) = 0;
};

}  // namespace understory
