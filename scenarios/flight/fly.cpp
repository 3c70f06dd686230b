#include "scenarios/flight/fly.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "estimation/filter.hpp"
#include "perception/full_stereo/full_stereo_detector.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectifying_detector.hpp"
#include "planning/autopilot.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/due.hpp"
#include "scenarios/flight/flight_computer.hpp"
#include "scenarios/flight/flight_film.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/flight/oracles/no_detector.hpp"
#include "scenarios/flight/oracles/true_depth.hpp"
#include "scenarios/flight/oracles/true_state.hpp"
#include "scenarios/flight/referee.hpp"
#include "scenarios/flight/run_record.hpp"
#include "scenarios/flight/simulated_parts.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/scenario/detection_depths.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "sim/cameras/frame_drops.hpp"
#include "sim/cameras/stereo_cameras.hpp"

namespace understory {
namespace {

template <typename MatcherConfig>
std::unique_ptr<ObstacleDetector> full_stereo_of(const CalibratedRig& cameras, const MatcherConfig& matcher,
                                                 const FullStereoCrop& crop) {
  auto detector = std::make_unique<FullStereoDetector>(cameras.rig, matcher, crop);
  if (!cameras.calibration) return detector;
  return std::make_unique<RectifyingDetector>(*cameras.calibration, std::move(detector));
}

std::unique_ptr<ObstacleDetector> detector_of(const Scenario& scenario, const CalibratedRig& cameras,
                                              const std::vector<Obstacle>& obstacles,
                                              const TruthHistory& history) {
  const StereoRig& rig = cameras.rig;
  switch (scenario.perception.detector) {
    case DetectorKind::pushbroom:
      check_depths(scenario.perception.pushbroom, rig, "perception.depths_m", "perception.pushbroom");
      if (cameras.calibration)
        return std::make_unique<PushbroomStereo>(*cameras.calibration, rig.detection_depth_m,
                                                 scenario.perception.pushbroom);
      return std::make_unique<PushbroomStereo>(rig, scenario.perception.pushbroom);
    case DetectorKind::stereo_bm:
      return full_stereo_of(cameras, scenario.perception.stereo_bm, scenario.perception.full_stereo);
    case DetectorKind::stereo_sgbm:
      return full_stereo_of(cameras, scenario.perception.stereo_sgbm, scenario.perception.full_stereo);
    case DetectorKind::true_depth:
      return std::make_unique<TrueDepth>(rig, obstacles, history);
    case DetectorKind::none:
      break;
  }
  return std::make_unique<NoDetector>();
}

std::unique_ptr<StateSource> state_source_of(const Scenario& scenario, const TruthHistory& history) {
  if (scenario.estimation.source == StateKind::truth) return std::make_unique<TrueState>(history);
  return std::make_unique<Filter>(scenario.estimation.filter);
}

/// The autopilot, with somebody listening in on its IMU.
struct Overheard {
  Autopilot& autopilot;
  const std::function<void(const ImuSample&)>& on_imu;

  void on(const ImuSample& sample) {
    if (on_imu) on_imu(sample);
    autopilot.on(sample);
  }
  template <typename Sample>
  void on(const Sample& sample) {
    autopilot.on(sample);
  }
};

}  // namespace

FlightResult fly(const Scenario& scenario, const FlyOptions& options) {
  Stopwatch stopwatch;
  const CalibratedRig calibrated = rig_of(scenario, options.models_folder);
  const StereoRig& rig = calibrated.rig;
  if (!options.output_folder.empty()) prepare_run_folder(scenario, options.output_folder);

  const std::vector<Obstacle> obstacles = course_obstacles(scenario);
  const World world =
      stopwatch.time("setup", [&] { return world_of(scenario, options.models_folder, obstacles); });
  Aircraft aircraft = aircraft_of(scenario, world);
  // Rendering an image that nobody looks at would be most of the flight's cost.
  const bool looking = looks(scenario.perception.detector);
  const auto cameras =
      looking || options.video || options.on_frame
          ? stopwatch.time("context",
                           [&] { return cameras_of(scenario, world, calibrated, options.renderer); })
          : nullptr;
  OnboardSensors sensors(scenario);

  TruthHistory history;
  const auto detector = detector_of(scenario, calibrated, obstacles, history);
  const auto state_source = state_source_of(scenario, history);
  AutopilotConfig autopilot_config = scenario.autopilot.autopilot;
  autopilot_config.resightings.depths_m = scenario.perception.pushbroom.depths_m;
  Autopilot autopilot(autopilot_config, scenario.airframe, rig, scenario.mission(), *detector, *state_source,
                      seed_for(scenario.seed, "planner"));

  Overheard overheard{autopilot, options.on_imu};
  const Due due(scenario);
  FrameDrops drops(scenario.cameras.drop_probability, seed_for(scenario.sensor_seed(), "camera_drops"));
  const std::int64_t lag_ns = scenario.cameras.cameras.exposure_lag_ns();
  const auto latency_ns = static_cast<std::int64_t>(scenario.cameras.latency_s * 1e9);
  FlightComputer computer(static_cast<std::int64_t>(scenario.perception.cost_s() * 1e9));
  Controls controls;
  Referee referee(scenario);
  RunRecord record(scenario, obstacles);
  if (cameras) record.result().renderer = cameras->renderer();
  std::optional<FlightFilm> film;
  std::optional<Rectifier> rectifier;  // for the film only: the detector rectifies what it looks at
  if (options.video && calibrated.calibration)
    rectifier.emplace(*calibrated.calibration, Interpolation::nearest);
  if (options.video) film.emplace(options.output_folder, rig, *cameras, scenario.frame_rate_hz());

  std::optional<Ending> ending;
  for (std::int64_t step = 0; !ending; ++step) {
    const Truth& truth = aircraft.truth();
    history.observe(truth);
    if (options.on_truth) options.on_truth(truth);
    stopwatch.time("estimate", [&] { sensors.deliver(due, step, truth, overheard); });
    if (options.on_estimate && due.imu(step)) options.on_estimate(autopilot.state());
    if (cameras) cameras->observe(aircraft.data(), truth.t_ns);
    if (due.camera(step) && !drops.next()) {
      // A busy computer drops frames: what it will not look at need not be rendered.
      const std::int64_t arrival_ns = truth.t_ns + latency_ns;
      const std::int64_t next_arrival_ns = time_of_step_ns(step + due.camera_steps) + latency_ns;
      const bool taken = computer.will_take(arrival_ns, next_arrival_ns) || !scenario.every_frame_arrives();
      StereoFrame frame{truth.t_ns - lag_ns, {}, {}};
      if (cameras && taken)
        frame = stopwatch.time("render", [&] { return cameras->capture(aircraft.data(), truth.t_ns); });
      if (sensors.faults().pass(frame)) computer.send(std::move(frame), arrival_ns);
    }
    while (const std::optional<StereoFrame> looked_at = computer.looked_at(truth.t_ns)) {
      const StereoFrame& frame = *looked_at;
      if (options.on_frame) stopwatch.time("record", [&] { options.on_frame(frame, *cameras); });
      stopwatch.time("detect", [&] { autopilot.on(frame); });
      stopwatch.time("record", [&] {
        record.observe(looking ? frame : StereoFrame{frame.t_ns, {}, {}}, autopilot.hits().size());
        record.remember_of_frame(
            autopilot.map().points(), frame.t_ns,
            history.at(frame.t_ns).T_world_body * state_source->state_at(frame.t_ns).T_world_body.inverse());
      });
      if (film)
        stopwatch.time("film", [&] {
          film->observe(rectifier ? rectifier->rectify(frame) : frame, autopilot, *state_source,
                        aircraft.data());
        });
    }
    if (due.replan(step)) stopwatch.time("replan", [&] { autopilot.replan(truth.t_ns); });
    if (due.imu(step)) controls = stopwatch.time("control", [&] { return autopilot.controls(truth.t_ns); });

    stopwatch.time("record", [&] {
      record.observe(truth, aircraft.launched());
      if (due.record(step)) record.observe(truth, autopilot.state(), controls, aircraft.launched());
    });
    if (options.on_progress && step % 120 == 0) {
      const FlightResult& so_far = record.result();
      options.on_progress({static_cast<double>(truth.t_ns) * 1e-9, stopwatch.elapsed_s(), so_far.progress_m,
                           scenario.goal_x_m(), truth.velocity_world_mps.norm(), so_far.min_clearance_m});
    }
    ending = referee.judge(truth, aircraft.contact(), aircraft.launched());
    if (!ending) stopwatch.time("physics", [&] { aircraft.step(controls); });
  }

  record.finish(*ending);
  record.result().planner = autopilot.counts();
  record.result().timings = stopwatch.timings();
  record.result().wall_s = stopwatch.elapsed_s();
  if (film) film->finish();
  if (!options.output_folder.empty()) record.write(options.output_folder);
  return record.result();
}

}  // namespace understory
