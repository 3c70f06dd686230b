#include "scenarios/onboard_sensors.hpp"

#include <cmath>

#include "scenarios/named_seed.hpp"

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

void OnboardSensors::deliver(const Due& due, std::int64_t step, const Truth& truth, Autopilot& autopilot) {
  const auto deliver_now = [&](auto sample) {
    if (faults_.pass(sample)) autopilot.on(sample);
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
