#include "scenarios/recording/carry.hpp"

#include <limits>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/due.hpp"
#include "scenarios/flight/run_record.hpp"
#include "scenarios/flight/simulated_parts.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/recording/euroc_recording.hpp"

namespace understory {

Carried carry_recorded(const Scenario& scenario, const Carriage& carriage, const FlyOptions& options) {
  const Stopwatch stopwatch;
  EurocRecording recording(options.output_folder, scenario, carriage.rig,
                           static_cast<double>(carriage.end_ns) * 1e-9);
  prepare_run_folder(scenario, options.output_folder);
  const World world = world_of(scenario, options.models_folder, carriage.obstacles);
  Aircraft aircraft = aircraft_of(scenario, world);  // set down at every step, never stepped
  const auto cameras = cameras_of(scenario, world, carriage.rig, options.renderer);
  Imu imu(scenario.sensors.sensors.imu, seed_for(scenario.sensor_seed(), "imu"));
  const Due due(scenario);
  Carried carried;
  Eigen::Vector3d before_world = carriage.truth_at(0).T_world_body.translation();
  for (std::int64_t step = 0; time_of_step_ns(step) < carriage.end_ns; ++step) {
    const Truth truth = carriage.truth_at(time_of_step_ns(step));
    carried.carried_s = static_cast<double>(truth.t_ns) * 1e-9;
    carried.carried_m += (truth.T_world_body.translation() - before_world).norm();
    before_world = truth.T_world_body.translation();
    aircraft.place(truth.T_world_body, truth.velocity_world_mps, truth.angular_rate_body_radps, Controls{});
    recording.observe(truth);
    cameras->observe(aircraft.data(), truth.t_ns);
    if (due.imu(step)) recording.add(imu.measure(truth));
    if (due.camera(step)) recording.add(cameras->capture(aircraft.data(), truth.t_ns), *cameras);
    if (options.on_progress && step % 120 == 0)
      options.on_progress({carried.carried_s, stopwatch.elapsed_s(), before_world.x(), scenario.goal_x_m(),
                           truth.velocity_world_mps.norm(), std::numeric_limits<double>::infinity()});
  }
  recording.finish();
  carried.frames = recording.frames();
  return carried;
}

}  // namespace understory
