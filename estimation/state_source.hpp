#pragma once

#include <cstdint>

#include "estimation/samples.hpp"
#include "estimation/state.hpp"

namespace understory {

/// Tells the autopilot where the aircraft is: the filter, or an oracle in its place. Samples arrive in order
/// of time.
class StateSource {
 public:
  virtual ~StateSource() = default;
  virtual void on(const ImuSample& sample) = 0;
  virtual void on(const PitotSample& sample) = 0;
  virtual void on(const BarometerSample& sample) = 0;
  virtual void on(const MagnetometerSample& sample) = 0;
  virtual void on(const GpsSample& sample) = 0;
  virtual void on(const ResightingSample& sample) = 0;
  virtual void on(const ThrustSample& sample) = 0;
  /// Newest state (its t_ns is that of the newest IMU sample).
  virtual const State& state() const = 0;
  /// State at an earlier moment, interpolated from the recorded history (1 s is kept); the nearest end of
  /// the history where t_ns lies outside it.
  virtual State state_at(std::int64_t t_ns) const = 0;
};

}  // namespace understory
