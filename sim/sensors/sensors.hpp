#pragma once

#include "sim/sensors/barometer.hpp"
#include "sim/sensors/gps.hpp"
#include "sim/sensors/imu.hpp"
#include "sim/sensors/magnetometer.hpp"
#include "sim/sensors/pitot.hpp"

namespace understory {

/// Whether samples of this rate fall on whole physics steps (1200 Hz), as every rate of a scenario must.
bool divides_physics_rate(int rate_hz);

/// Rates must divide 1200 Hz (divides_physics_rate; whoever loads a scenario checks).
struct SensorsConfig {
  int imu_rate_hz = 200;
  int pitot_rate_hz = 50;
  int barometer_rate_hz = 50;
  int magnetometer_rate_hz = 50;
  int gps_rate_hz = 5;  ///< fixes, where sensors.gps.enabled
  ImuConfig imu;
  PitotConfig pitot;
  BarometerConfig barometer;
  MagnetometerConfig magnetometer;
  GpsConfig gps;
};

template <typename Visitor>
void visit_fields(Visitor& visit, SensorsConfig& config) {
  visit("imu_rate_hz", config.imu_rate_hz, 1, 1200);
  visit("pitot_rate_hz", config.pitot_rate_hz, 1, 1200);
  visit("barometer_rate_hz", config.barometer_rate_hz, 1, 1200);
  visit("magnetometer_rate_hz", config.magnetometer_rate_hz, 1, 1200);
  visit("gps_rate_hz", config.gps_rate_hz, 1, 1200);
  visit("imu", config.imu);
  visit("pitot", config.pitot);
  visit("barometer", config.barometer);
  visit("magnetometer", config.magnetometer);
  visit("gps", config.gps);
}

}  // namespace understory
