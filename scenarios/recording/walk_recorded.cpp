#include <algorithm>
#include <limits>

#include "scenarios/due.hpp"
#include "scenarios/named_seed.hpp"
#include "scenarios/recording/euroc_recording.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/run_record.hpp"
#include "scenarios/scenario_io.hpp"
#include "scenarios/scenario_rig.hpp"
#include "scenarios/simulated_parts.hpp"
#include "scenarios/stopwatch.hpp"

namespace understory {

RecordedWalk walk_recorded(const Scenario& scenario, const WalkConfig& config, const FlyOptions& options) {
  const Stopwatch stopwatch;
  const CalibratedRig rig = rig_of(scenario, options.models_folder);
  const std::vector<Obstacle> obstacles = course_obstacles(scenario);
  RecordedWalk walk;
  walk.path = walk_path(config, scenario, rig.rig, obstacles);
  const double way_m = scenario.goal_x_m() - walk.path.from_x_m;
  EurocRecording recording(options.output_folder, scenario, rig,
                           std::min(scenario.time_limit_s, way_m / config.speed_mps));
  prepare_run_folder(scenario, options.output_folder);

  const World world = world_of(scenario, options.models_folder, obstacles);
  Aircraft carried = aircraft_of(scenario, world);  // set down at every step, never stepped
  const auto cameras = cameras_of(scenario, world, rig, options.renderer);
  Imu imu(scenario.sensors.sensors.imu, seed_for(scenario.sensor_seed(), "imu"));
  const Due due(scenario);
  for (std::int64_t step = 0;; ++step) {
    const Truth truth = walk_truth(walk.path, time_of_step_ns(step));
    walk.walked_s = static_cast<double>(truth.t_ns) * 1e-9;
    walk.walked_m = config.speed_mps * walk.walked_s;
    if (walk.walked_m >= way_m || walk.walked_s >= scenario.time_limit_s) break;
    carried.place(truth.T_world_body, truth.velocity_world_mps, truth.angular_rate_body_radps, Controls{});
    recording.observe(truth);
    cameras->observe(carried.data(), truth.t_ns);
    if (due.imu(step)) recording.add(imu.measure(truth));
    if (due.camera(step)) recording.add(cameras->capture(carried.data(), truth.t_ns), *cameras);
    if (options.on_progress && step % 120 == 0)
      options.on_progress({walk.walked_s, stopwatch.elapsed_s(), walk.path.from_x_m + walk.walked_m,
                           scenario.goal_x_m(), config.speed_mps, std::numeric_limits<double>::infinity()});
  }
  recording.finish();
  walk.frames = recording.frames();
  return walk;
}

}  // namespace understory
