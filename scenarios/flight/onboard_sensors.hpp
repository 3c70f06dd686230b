#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <tuple>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/scene/world_config.hpp"
#include "sim/sensors/faults.hpp"
#include "sim/sensors/sensors.hpp"

namespace understory {

/// Time as a count of physics steps, and what is due at each. Nothing drifts, and no float is compared.
class FlightClock {
 public:
  explicit FlightClock(const Scenario& scenario, std::int64_t step = 0)
      : step_(step),
        imu_steps_(physics_rate_hz / scenario.sensors.imu_rate_hz),
        pitot_steps_(physics_rate_hz / scenario.sensors.pitot_rate_hz),
        barometer_steps_(physics_rate_hz / scenario.sensors.barometer_rate_hz),
        magnetometer_steps_(physics_rate_hz / scenario.sensors.magnetometer_rate_hz),
        gps_steps_(physics_rate_hz / scenario.sensors.gps_rate_hz),
        gps_enabled_(scenario.sensors.gps.enabled),
        camera_steps_(physics_rate_hz / scenario.cameras.rate_hz),
        replan_steps_(physics_rate_hz / scenario.autopilot.replan_rate_hz) {}

  std::int64_t step() const { return step_; }
  std::int64_t t_ns() const { return time_of_step_ns(step_); }
  double t_s() const { return static_cast<double>(t_ns()) * 1e-9; }
  void advance() { ++step_; }

  bool imu() const { return step_ % imu_steps_ == 0; }
  bool pitot() const { return step_ % pitot_steps_ == 0; }
  bool barometer() const { return step_ % barometer_steps_ == 0; }
  bool magnetometer() const { return step_ % magnetometer_steps_ == 0; }
  bool gps() const { return gps_enabled_ && step_ % gps_steps_ == 0; }
  bool camera() const { return step_ % camera_steps_ == 0; }
  bool replan() const { return step_ % replan_steps_ == 0; }
  /// End of the next frame's exposure, if one ends now.
  std::int64_t next_camera_t_ns() const { return time_of_step_ns(step_ + camera_steps_); }

 private:
  std::int64_t step_;
  std::int64_t imu_steps_, pitot_steps_, barometer_steps_, magnetometer_steps_, gps_steps_;
  bool gps_enabled_;
  std::int64_t camera_steps_, replan_steps_;
};

/// The aircraft's sensors except the cameras, each with its own generator, and the faults between sensors and
/// autopilot.
class OnboardSensors {
 public:
  explicit OnboardSensors(const Scenario& scenario);

  /// Measures what is due now and gives `receiver`, an Autopilot or a StateSource, the samples that arrive
  /// now. A GPS fix arrives late.
  template <typename Receiver>
  void deliver(const FlightClock& clock, const Truth& truth, Receiver& receiver);
  /// From now on other noise; the errors that are constant in a flight stay.
  void redraw(std::uint64_t seed);
  /// The newest sample of its kind that was handed over.
  template <typename Sample>
  const std::optional<Sample>& newest() const {
    return std::get<std::optional<Sample>>(newest_);
  }
  /// For the cameras' frames, which the flight delivers.
  Faults& faults() { return faults_; }
  const Faults& faults() const { return faults_; }

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

inline OnboardSensors::OnboardSensors(const Scenario& scenario)
    : imu_(scenario.sensors.imu, seed_for(scenario.sensor_seed(), "imu")),
      pitot_(scenario.sensors.pitot, scenario.airframe.air_density_kgpm3,
             seed_for(scenario.sensor_seed(), "pitot")),
      barometer_(scenario.sensors.barometer, seed_for(scenario.sensor_seed(), "barometer")),
      magnetometer_(scenario.sensors.magnetometer, seed_for(scenario.sensor_seed(), "magnetometer")),
      gps_(scenario.sensors.gps, seed_for(scenario.sensor_seed(), "gps")),
      gps_delay_ns_(nanoseconds(scenario.sensors.gps.delay_s)),
      faults_(scenario.faults) {}

inline void OnboardSensors::redraw(std::uint64_t seed) {
  imu_.redraw(seed_for(seed, "imu"));
  pitot_.redraw(seed_for(seed, "pitot"));
  barometer_.redraw(seed_for(seed, "barometer"));
  magnetometer_.redraw(seed_for(seed, "magnetometer"));
  gps_.redraw(seed_for(seed, "gps"));
}

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
