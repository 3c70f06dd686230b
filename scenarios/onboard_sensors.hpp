#pragma once

#include <deque>

#include "planning/autopilot.hpp"
#include "scenarios/due.hpp"
#include "sim/faults.hpp"
#include "sim/sensors.hpp"

namespace understory {

/// The aircraft's sensors but for the cameras, each with a generator of its own, and the faults that stand
/// between them and the autopilot.
class OnboardSensors {
 public:
  explicit OnboardSensors(const Scenario& scenario);

  /// Measures what is due at this step and hands the autopilot what arrives now; a satellite fix arrives
  /// late.
  void deliver(const Due& due, std::int64_t step, const Truth& truth, Autopilot& autopilot);
  /// For the cameras' frames, which the loop itself delivers.
  Faults& faults() { return faults_; }

 private:
  Imu imu_;
  Pitot pitot_;
  Barometer barometer_;
  Magnetometer magnetometer_;
  Gps gps_;
  std::int64_t gps_delay_ns_;
  std::deque<GpsSample> fixes_under_way_;
  Faults faults_;
};

}  // namespace understory
