#include "tests/validation/estimator_trial.hpp"

#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <future>
#include <limits>
#include <memory>
#include <random>

#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario_io.hpp"

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
  SightingAgain(const FlightTrace& flight, const TrialConfig& config)
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

FlightTrace traced_flight(Scenario scenario, const std::string& flown_on) {
  scenario.perception.detector = "true_depth";
  scenario.estimation.source = flown_on;
  FlightLogger logger;
  Flight flight(scenario, {UNDERSTORY_SOURCE_DIR "/models"}, {&logger});
  FlightTrace trace{scenario, flight.rig().rig, flight.obstacles()};
  while (!flight.outcome()) {
    if (!flight.launched()) ++trace.release_step;
    trace.truths.push_back(flight.truth());
    flight.step();
  }
  trace.result = logger.log().result;
  return trace;
}

Scenario forest_in(const Air& air, std::uint64_t seed) {
  Scenario scenario =
      load_scenario(UNDERSTORY_SOURCE_DIR "/scenarios/library/forest.yaml", {fmt::format("seed={}", seed)});
  scenario.autopilot = planning_of(PlanningPreset::thorough);
  scenario.wind_world_mps = {0, air.wind_mps, 0};
  if (air.turbulent) scenario.wind.turbulence_wind20_mps = air.wind_mps;
  return scenario;
}

int measure_flights(int flights, const std::function<Scenario(int)>& scenario, double minimum_s,
                    const std::function<void(int, const FlightTrace&)>& measure) {
  std::future<void> measured;
  int left_out = 0;
  for (int number = 0; number < flights; ++number) {
    auto flight = std::make_shared<FlightTrace>(traced_flight(scenario(number)));
    if (static_cast<double>(flight->truths.size()) < minimum_s * physics_rate_hz) {
      ++left_out;
      continue;
    }
    if (measured.valid()) measured.get();
    measured = std::async(std::launch::async, [&measure, number, flight] { measure(number, *flight); });
  }
  if (measured.valid()) measured.get();
  return left_out;
}

Sightings sightings(const FlightTrace& flight, const std::vector<double>& depths_m) {
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

TrialConfig trial_of(const FlightTrace& flight, std::uint64_t sensor_seed) {
  TrialConfig config;
  config.filter = flight.scenario.estimation.filter();
  config.sensors = flight.scenario.sensors;
  config.sensor_seed = sensor_seed;
  return config;
}

void take_preset(TrialConfig& config, const FilterConfig& preset) {
  const StartConfig start = config.filter.start;
  config.filter = preset;
  config.filter.start = start;
}

void draw_aim(TrialConfig& config) {
  std::mt19937_64 generator(config.sensor_seed);
  StartConfig& start = config.filter.start;
  start.yaw_rad = std::normal_distribution<double>(0, start.yaw_sigma_rad)(generator);
}

ErrorVector TrialMoment::error() const {
  const Eigen::Matrix3d true_R = truth.T_world_body.linear();
  const Eigen::AngleAxisd apart(Eigen::Matrix3d(estimate.T_world_body.linear().transpose() * true_R));
  ErrorVector error = ErrorVector::Zero();
  error.segment<3>(attitude_block) = apart.angle() * apart.axis();
  error.segment<3>(velocity_block) =
      true_R.transpose() * truth.velocity_world_mps - estimate.velocity_body_mps;
  error.segment<3>(position_block) = truth.T_world_body.translation() - estimate.T_world_body.translation();
  return error;
}

std::vector<TrialMoment> run_trial(const FlightTrace& flight, const TrialConfig& config) {
  Scenario scenario = flight.scenario;
  static_cast<SensorsConfig&>(scenario.sensors) = config.sensors;
  scenario.sensors.seed = config.sensor_seed;
  OnboardSensors sensors(scenario);
  FlightClock clock(scenario, config.ground_velocity_unknown ? flight.release_step : 0);
  const auto truth_now = [&]() -> const Truth& {
    return flight.truths.at(static_cast<std::size_t>(clock.step()));
  };
  Filter filter(config.ground_velocity_unknown ? woken_at(truth_now(), config.filter) : config.filter);
  SightingAgain sighting(flight, config);
  std::vector<TrialMoment> moments;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  std::array<double, aid_count> seen{};
  seen.fill(nothing);
  for (; clock.step() < static_cast<std::int64_t>(flight.truths.size()); clock.advance()) {
    const Truth& truth = truth_now();
    sensors.deliver(clock, truth, filter);
    filter.on(ThrustSample{truth.t_ns, truth.thrust_n});
    sighting.step(truth.t_ns, filter);
    if (!clock.imu()) continue;
    TrialMoment& moment = moments.emplace_back();
    moment.truth = truth;
    moment.estimate = filter.state();
    for (std::size_t aid = 0; aid < seen.size(); ++aid) {
      const double newest = filter.innovation_squared(static_cast<Aid>(aid));
      moment.innovations_squared[aid] = newest == seen[aid] ? nothing : newest;  // nothing: none, or the same
      seen[aid] = newest;
    }
  }
  return moments;
}

}  // namespace understory
