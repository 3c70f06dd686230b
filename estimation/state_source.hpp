#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "estimation/state.hpp"

namespace understory {

/// Tells the autopilot where the aircraft is. Samples arrive in the order in which the aircraft's computer
/// gets them; a GPS fix or a resighting is older than the IMU sample before it.
class StateSource {
 public:
  virtual ~StateSource() = default;
  /// Takes one sample; a source ignores the kinds that it has no use for (std::get_if).
  virtual void on(const Sample& sample) = 0;
  /// Newest state (its t_ns is that of the newest IMU sample).
  virtual const State& state() const = 0;
  /// State at an earlier moment, interpolated from the recorded history (1 s is kept); the nearest end of
  /// the history where t_ns lies outside it.
  virtual State state_at(std::int64_t t_ns) const = 0;
};

}  // namespace understory
