#pragma once

#include <deque>

#include "scenarios/flight/due.hpp"
#include "sim/sensors/faults.hpp"
#include "sim/sensors/sensors.hpp"

namespace understory {

/// The aircraft's sensors but for the cameras, each with a generator of its own, and the faults that stand
/// between them and the autopilot.
class OnboardSensors {
 public:
  explicit OnboardSensors(const Scenario& scenario);

  /// Measures what is due at this step and hands `receiver`, an Autopilot or a StateSource, what arrives now;
  /// a satellite fix arrives late.
  template <typename Receiver>
  void deliver(const Due& due, std::int64_t step, const Truth& truth, Receiver& receiver);
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

template <typename Receiver>
void OnboardSensors::deliver(const Due& due, std::int64_t step, const Truth& truth, Receiver& receiver) {
  const auto deliver_now = [&](auto sample) {
    if (faults_.pass(sample)) receiver.on(sample);
  };
  if (due.imu(step)) deliver_now(imu_.measure(truth));
  if (due.pitot(step)) deliver_now(pitot_.measure(truth));
  if (due.barometer(step)) deliver_now(barometer_.measure(truth));
  if (due.magnetometer(step)) deliver_now(magnetometer_.measure(truth));
  if (due.gps(step)) fixes_under_way_.push_back(gps_.measure(truth));
  while (!fixes_under_way_.empty() && truth.t_ns >= fixes_under_way_.front().t_ns + gps_delay_ns_) {
    deliver_now(fixes_under_way_.front());
    fixes_under_way_.pop_front();
  }
}

}  // namespace understory
