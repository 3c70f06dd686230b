#include "tests/validation/estimator_trial.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/flight/oracles.hpp"

namespace understory {
namespace {

/// The pushbroom's view of one depth: every block that truly lies there, put at the whole disparity's depth.
class Sight {
 public:
  Sight(StereoRig rig, double depth_m, const std::vector<Obstacle>& obstacles, const TruthHistory& history)
      : rig_(at_depth(std::move(rig), depth_m)), detector_(rig_, obstacles, history) {
    depth_m_ = rig_.depth_m(std::round(rig_.disparity_px(depth_m)));
  }
  void see(std::int64_t t_ns, std::vector<StereoHit>& hits) {
    for (StereoHit hit : detector_.detect({t_ns, {}, {}})) {
      hit.position_camera *= depth_m_ / hit.position_camera.z();
      hits.push_back(hit);
    }
  }
  double depth_m() const { return depth_m_; }

 private:
  static StereoRig at_depth(StereoRig rig, double depth_m) {
    rig.detection_depth_m = depth_m;
    return rig;
  }
  StereoRig rig_;
  TrueDepth detector_;
  double depth_m_ = 0;
};

/// Tells the filter of what was seen again, one latency late.
class SightingAgain {
 public:
  SightingAgain(const RecordedFlight& flight, const TrialConfig& config)
      : seen_(config.sightings),
        T_body_camera_(flight.rig.T_body_camera),
        latency_ns_(std::llround(flight.scenario.cameras.latency_s * 1e9)),
        resightings_(known(config)) {}
  void step(std::int64_t t_ns, Filter& filter) {
    if (seen_ == nullptr) return;
    for (; next_ < seen_->t_ns.size() && t_ns >= seen_->t_ns[next_] + latency_ns_; ++next_) {
      const std::int64_t image_ns = seen_->t_ns[next_];
      resightings_.insert(seen_->hits[next_], filter.state_at(image_ns).T_world_body * T_body_camera_,
                          image_ns);
      for (const Resighting& again : resightings_.completed())
        filter.on(
            ResightingSample{again.t_ns, again.earlier_ns, again.discrepancy_world_m, again.covariance_m2});
    }
  }

 private:
  static ResightingsConfig known(const TrialConfig& config) {
    ResightingsConfig resightings = config.resightings;
    if (config.sightings != nullptr) resightings.depths_m = config.sightings->depths_m;
    return resightings;
  }
  const Sightings* seen_;
  Eigen::Isometry3d T_body_camera_;
  std::int64_t latency_ns_;
  std::size_t next_ = 0;
  Resightings resightings_;
};

/// See TrialConfig::ground_velocity_unknown.
FilterConfig woken_at(const Truth& truth, FilterConfig filter) {
  const Eigen::Matrix3d R = truth.T_world_body.linear();
  StartConfig& start = filter.start;
  start.in_flight = true;
  start.position_world_m = truth.T_world_body.translation();
  start.yaw_rad = std::atan2(R(1, 0), R(0, 0));
  start.pitch_rad = std::asin(R(2, 0));
  start.roll_rad = std::atan2(R(2, 1), R(2, 2));
  start.velocity_body_mps = R.transpose() * (truth.velocity_world_mps - truth.wind_world_mps);
  start.velocity_sigma_mps = 3.0;
  return filter;
}

}  // namespace

void take_preset(TrialConfig& config, const FilterConfig& preset) {
  const StartConfig start = config.filter.start;
  config.filter = preset;
  config.filter.start = start;
}

Sightings sightings(const RecordedFlight& flight, const std::vector<double>& depths_m) {
  Sightings seen;
  TruthHistory history;
  std::deque<Sight> sights;
  for (const double depth_m : depths_m) {
    sights.emplace_back(flight.rig, depth_m, flight.obstacles, history);
    seen.depths_m.push_back(sights.back().depth_m());
  }
  const auto period = static_cast<std::size_t>(physics_rate_hz / flight.scenario.cameras.rate_hz);
  for (std::size_t step = 0; step < flight.truths.size(); ++step) {
    history.observe(flight.truths[step]);
    if (step % period != 0) continue;
    seen.t_ns.push_back(flight.truths[step].t_ns);
    seen.hits.emplace_back();
    for (Sight& sight : sights) sight.see(seen.t_ns.back(), seen.hits.back());
  }
  return seen;
}

std::vector<TrialMoment> run_trial(const RecordedFlight& flight, const TrialConfig& config) {
  Scenario scenario = flight.scenario;
  scenario.sensors.sensors = config.sensors;
  scenario.sensors.seed = config.sensor_seed;
  scenario.faults = config.faults;
  OnboardSensors sensors(scenario);
  const std::size_t first =
      config.ground_velocity_unknown ? static_cast<std::size_t>(flight.release_step) : std::size_t{0};
  Filter filter(config.ground_velocity_unknown ? woken_at(flight.truths.at(first), config.filter)
                                               : config.filter);
  SightingAgain sighting(flight, config);
  FlightClock clock(scenario, static_cast<std::int64_t>(first));
  std::vector<TrialMoment> moments;
  std::array<double, aid_count> seen{};
  seen.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = first; i < flight.truths.size(); ++i, clock.advance()) {
    const Truth& truth = flight.truths[i];
    sensors.deliver(clock, truth, filter);
    sighting.step(truth.t_ns, filter);
    if (!clock.imu()) continue;
    TrialMoment& moment = moments.emplace_back();
    moment.truth = truth;
    moment.estimate = filter.state();
    for (int aid = 0; aid < aid_count; ++aid) {
      const auto a = static_cast<std::size_t>(aid);
      const double newest = filter.innovation_squared(static_cast<Aid>(aid));
      moment.innovations_squared[a] =
          newest == seen[a] ? std::numeric_limits<double>::quiet_NaN() : newest;  // nan: none, or the same
      seen[a] = newest;
      moment.faulty[a] = filter.faulty(static_cast<Aid>(aid));
    }
  }
  return moments;
}

std::vector<Drift> drifts(const RecordedFlight& flight, const std::vector<TrialMoment>& moments,
                          double sight_m, double from_s) {
  const double release_s = static_cast<double>(flight.release_step) / physics_rate_hz;
  const Eigen::Vector3d forward_body =
      (flight.rig.T_body_camera.linear() * Eigen::Vector3d::UnitZ()).normalized();
  std::vector<Drift> found;
  const auto seconds = [](const TrialMoment& moment) {
    return 1e-9 * static_cast<double>(moment.truth.t_ns);
  };
  double next_s = release_s + from_s;
  for (std::size_t seen = 0; seen < moments.size(); ++seen) {
    if (seconds(moments[seen]) < next_s) continue;
    next_s += 0.05;
    const Eigen::Vector3d ahead_body = sight_m * forward_body;
    const Eigen::Vector3d point_world = moments[seen].truth.T_world_body * ahead_body;
    // Passed: the point no longer lies ahead along the course over ground.
    std::size_t passed = seen + 1;
    const auto ahead_m = [&](const TrialMoment& moment) {
      return (point_world - moment.truth.T_world_body.translation()).dot(moment.truth.velocity_world_mps);
    };
    while (passed < moments.size() && ahead_m(moments[passed]) > 0) ++passed;
    if (passed == moments.size()) break;
    const TrialMoment& then = moments[seen];
    const TrialMoment& now = moments[passed];
    const Eigen::Vector3d true_body = now.truth.T_world_body.inverse() * point_world;
    const Eigen::Vector3d remembered_body =
        now.estimate.T_world_body.inverse() * (then.estimate.T_world_body * ahead_body);
    const Eigen::Vector3d error_world = now.truth.T_world_body.linear() * (remembered_body - true_body);
    const Eigen::Vector2d course = now.truth.velocity_world_mps.head<2>().normalized();
    Drift& drift = found.emplace_back();
    drift.seen_s = seconds(then);
    drift.along_across_m = {error_world.head<2>().dot(course),
                            error_world.head<2>().dot(Eigen::Vector2d(-course.y(), course.x()))};
    drift.vertical_m = error_world.z();
    // The position error grows by the velocity's, which lasts: sigma of the difference is the interval times
    // the velocity's sigma, to first order (docs: the filter keeps no clone of its past).
    const double interval_s = seconds(now) - seconds(then);
    const auto velocity = now.estimate.covariance.block<3, 3>(velocity_block, velocity_block);
    drift.stated_sigma_m = interval_s * std::sqrt(velocity.trace());
  }
  return found;
}

ErrorVector error_of(const TrialMoment& moment) {
  const Eigen::Matrix3d R = moment.estimate.T_world_body.linear();
  const Eigen::AngleAxisd apart(Eigen::Matrix3d(R.transpose() * moment.truth.T_world_body.linear()));
  ErrorVector error = ErrorVector::Zero();
  error.segment<3>(attitude_block) = apart.angle() * apart.axis();
  error.segment<3>(velocity_block) =
      moment.truth.T_world_body.linear().transpose() * moment.truth.velocity_world_mps -
      moment.estimate.velocity_body_mps;
  error.segment<3>(position_block) =
      moment.truth.T_world_body.translation() - moment.estimate.T_world_body.translation();
  return error;
}

}  // namespace understory
