#pragma once

#include <cstdint>

#include "scenarios/scenario/scenario.hpp"
#include "sim/scene/world_config.hpp"

namespace understory {

/// Time as a count of physics steps, and what is due at each. Nothing drifts, and no float is compared.
class FlightClock {
 public:
  explicit FlightClock(const Scenario& scenario, std::int64_t step = 0)
      : step_(step),
        imu_steps_(physics_rate_hz / scenario.sensors.sensors.imu_rate_hz),
        pitot_steps_(physics_rate_hz / scenario.sensors.sensors.pitot_rate_hz),
        barometer_steps_(physics_rate_hz / scenario.sensors.sensors.barometer_rate_hz),
        magnetometer_steps_(physics_rate_hz / scenario.sensors.sensors.magnetometer_rate_hz),
        gps_steps_(physics_rate_hz / scenario.sensors.sensors.gps_rate_hz),
        gps_enabled_(scenario.sensors.sensors.gps.enabled),
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
  /// End of the next frame's exposure, where one ends now.
  std::int64_t next_camera_t_ns() const { return time_of_step_ns(step_ + camera_steps_); }

 private:
  std::int64_t step_;
  std::int64_t imu_steps_, pitot_steps_, barometer_steps_, magnetometer_steps_, gps_steps_;
  bool gps_enabled_;
  std::int64_t camera_steps_, replan_steps_;
};

}  // namespace understory
