#pragma once

#include <cstdint>

#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// What is due at which physics step. Time is a count of steps, so nothing ever drifts or is compared as a
/// float.
struct Due {
  explicit Due(const Scenario& scenario)
      : imu_steps(physics_rate_hz / scenario.sensors.sensors.imu_rate_hz),
        pitot_steps(physics_rate_hz / scenario.sensors.sensors.pitot_rate_hz),
        barometer_steps(physics_rate_hz / scenario.sensors.sensors.barometer_rate_hz),
        magnetometer_steps(physics_rate_hz / scenario.sensors.sensors.magnetometer_rate_hz),
        gps_steps(physics_rate_hz / scenario.sensors.sensors.gps_rate_hz),
        gps_enabled(scenario.sensors.sensors.gps.enabled),
        camera_steps(physics_rate_hz / scenario.cameras.rate_hz),
        replan_steps(physics_rate_hz / scenario.autopilot.replan_rate_hz) {}

  bool imu(std::int64_t step) const { return step % imu_steps == 0; }
  bool pitot(std::int64_t step) const { return step % pitot_steps == 0; }
  bool barometer(std::int64_t step) const { return step % barometer_steps == 0; }
  bool magnetometer(std::int64_t step) const { return step % magnetometer_steps == 0; }
  bool gps(std::int64_t step) const { return gps_enabled && step % gps_steps == 0; }
  bool camera(std::int64_t step) const { return step % camera_steps == 0; }
  bool replan(std::int64_t step) const { return step % replan_steps == 0; }
  bool record(std::int64_t step) const { return step % 6 == 0; }  ///< 200 Hz

  std::int64_t imu_steps, pitot_steps, barometer_steps, magnetometer_steps, gps_steps;
  bool gps_enabled;
  std::int64_t camera_steps, replan_steps;
};

}  // namespace understory
