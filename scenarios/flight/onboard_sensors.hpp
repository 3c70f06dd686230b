#pragma once

#include <deque>
#include <optional>
#include <tuple>

#include "scenarios/flight/flight_clock.hpp"
#include "sim/sensors/faults.hpp"
#include "sim/sensors/sensors.hpp"

namespace understory {

/// The aircraft's sensors except the cameras, each with its own generator, and the faults between sensors and
/// autopilot.
class OnboardSensors {
 public:
  explicit OnboardSensors(const Scenario& scenario);

  /// Measures what is due now and gives `receiver`, an Autopilot or a StateSource, the samples that arrive
  /// now. A GPS fix arrives late.
  template <typename Receiver>
  void deliver(const FlightClock& clock, const Truth& truth, Receiver& receiver);
  /// The newest sample of its kind that was handed over.
  template <typename Sample>
  const std::optional<Sample>& newest() const {
    return std::get<std::optional<Sample>>(newest_);
  }
  /// For the cameras' frames, which the flight delivers.
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
  std::tuple<std::optional<ImuSample>, std::optional<PitotSample>, std::optional<BarometerSample>,
             std::optional<MagnetometerSample>, std::optional<GpsSample>>
      newest_;
};

template <typename Receiver>
void OnboardSensors::deliver(const FlightClock& clock, const Truth& truth, Receiver& receiver) {
  const auto deliver_now = [&]<typename Sample>(Sample sample) {
    if (!faults_.pass(sample)) return;
    std::get<std::optional<Sample>>(newest_) = sample;
    receiver.on(sample);
  };
  if (clock.imu()) deliver_now(imu_.measure(truth));
  if (clock.pitot()) deliver_now(pitot_.measure(truth));
  if (clock.barometer()) deliver_now(barometer_.measure(truth));
  if (clock.magnetometer()) deliver_now(magnetometer_.measure(truth));
  if (clock.gps()) fixes_under_way_.push_back(gps_.measure(truth));
  while (!fixes_under_way_.empty() && truth.t_ns >= fixes_under_way_.front().t_ns + gps_delay_ns_) {
    deliver_now(fixes_under_way_.front());
    fixes_under_way_.pop_front();
  }
}

}  // namespace understory
