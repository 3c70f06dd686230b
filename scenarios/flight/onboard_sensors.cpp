#include "scenarios/flight/onboard_sensors.hpp"

#include <cmath>

#include "scenarios/config/named_seed.hpp"

namespace understory {

OnboardSensors::OnboardSensors(const Scenario& scenario)
    : imu_(scenario.sensors.sensors.imu, seed_for(scenario.sensor_seed(), "imu")),
      pitot_(scenario.sensors.sensors.pitot, scenario.airframe.air_density_kgpm3,
             seed_for(scenario.sensor_seed(), "pitot")),
      barometer_(scenario.sensors.sensors.barometer, seed_for(scenario.sensor_seed(), "barometer")),
      magnetometer_(scenario.sensors.sensors.magnetometer, seed_for(scenario.sensor_seed(), "magnetometer")),
      gps_(scenario.sensors.sensors.gps, seed_for(scenario.sensor_seed(), "gps")),
      gps_delay_ns_(std::llround(scenario.sensors.sensors.gps.delay_s * 1e9)),
      faults_(scenario.faults) {}

}  // namespace understory
