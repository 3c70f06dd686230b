#include "scenarios/recording/record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/recording/carried_path.hpp"
#include "scenarios/recording/recording.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

/// Longer than any flight to the goal.
double longest_flight_s(const Scenario& scenario) {
  constexpr double slow_mps = 8;
  return std::min(scenario.time_limit_s, scenario.launch.rest_s + 1 + scenario.goal_x_m() / slow_mps);
}

/// Carries a scenario's cameras and IMU. `truth_at` is called step by step from 0.
Carried carry_recorded(const Scenario& scenario, const CalibratedRig& rig,
                       const std::function<Truth(std::int64_t t_ns)>& truth_at, std::int64_t end_ns,
                       const FlyOptions& options, const RecordingChoice& choice) {
  const Stopwatch stopwatch;
  const auto recording =
      recording_of(choice, options.output_folder, scenario, rig, static_cast<double>(end_ns) * 1e-9);
  const World world = world_of(scenario, options.models_folder);
  const auto cameras = cameras_of(scenario, world, rig, options.renderer);
  Imu imu(scenario.sensors.imu, seed_for(scenario.sensor_seed(), "imu"));
  Carried carried;
  Eigen::Vector3d before_world = truth_at(0).T_world_body.translation();
  for (FlightClock clock(scenario); clock.t_ns() < end_ns; clock.advance()) {
    const Truth truth = truth_at(clock.t_ns());
    carried.carried_s = clock.t_s();
    carried.carried_m += (truth.T_world_body.translation() - before_world).norm();
    before_world = truth.T_world_body.translation();
    recording->observe(truth);
    cameras->observe(truth.T_world_body, truth.t_ns);
    if (clock.imu()) recording->add(imu.measure(truth));
    if (clock.camera()) recording->add(cameras->capture(truth.T_world_body, truth.t_ns), *cameras);
    if (options.on_progress && clock.step() % 120 == 0)
      options.on_progress({carried.carried_s, stopwatch.elapsed_s(), before_world.x(), scenario.goal_x_m(),
                           truth.velocity_world_mps.norm(), std::numeric_limits<double>::infinity()});
  }
  recording->finish();
  carried.frames = recording->frames();
  return carried;
}

}  // namespace

FlownRecording fly_recorded(const Scenario& scenario, FlyOptions options, const RecordingChoice& choice) {
  const auto recording = recording_of(choice, options.output_folder, scenario,
                                      rig_of(scenario, options.models_folder), longest_flight_s(scenario));
  options.observers.push_back(recording.get());
  const FlightResult result = fly(scenario, options);
  recording->finish();
  return {result, recording->frames()};
}

RecordedWalk walk_recorded(const Scenario& scenario, const WalkConfig& config, const FlyOptions& options,
                           const RecordingChoice& choice) {
  const CalibratedRig rig = rig_of(scenario, options.models_folder);
  const WalkPath path = walk_path(config, scenario, rig.rig, course_obstacles(scenario));
  const auto truth_at = [&](std::int64_t t_ns) { return walk_truth(path, t_ns); };
  const double way_s = (scenario.goal_x_m() - path.from_x_m) / config.speed_mps;
  const std::int64_t end_ns = std::llround(std::min(way_s, scenario.time_limit_s) * 1e9);
  return {path, carry_recorded(scenario, rig, truth_at, end_ns, options, choice)};
}

Carried follow_recorded(const Scenario& scenario, const std::vector<TimedPose>& poses,
                        const FlyOptions& options, const RecordingChoice& choice) {
  const SmoothPath path(thinned(poses));
  const auto truth_at = [&](std::int64_t t_ns) {
    return carried_truth([&](double t_s) { return path.at(t_s); }, t_ns, scenario.airframe.gravity_mps2);
  };
  const std::int64_t end_ns = std::llround(path.length_s() * 1e9) + 1;  // the last pose, too
  return carry_recorded(scenario, rig_of(scenario, options.models_folder), truth_at, end_ns, options, choice);
}

}  // namespace understory
