#include "scenarios/flight/flight_logger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

#include "planning/path_follower.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight_story.hpp"

namespace understory {
namespace {

/// A moment every 5 ms, 6 cm of flight.
constexpr std::int64_t moment_every_steps = physics_rate_hz / 200;

std::span<const std::byte> bytes_of(const cv::Mat& image) {
  return std::as_bytes(std::span(image.data, image.total() * image.elemSize()));
}

LogMoment moment_of(const Flight& flight, const ClearanceField& clearance) {
  const Truth& truth = flight.truth();
  const State& state = flight.state();
  LogMoment moment;
  moment.t_ns = flight.clock().t_ns();
  moment.T_world_body = truth.T_world_body;
  moment.velocity_world_mps = truth.velocity_world_mps;
  moment.angular_rate_body_radps = truth.angular_rate_body_radps;
  moment.left_elevon_rad = truth.left_elevon_rad;
  moment.right_elevon_rad = truth.right_elevon_rad;
  moment.thrust_n = truth.thrust_n;
  moment.clearance_m = clearance.clearance_m(truth.T_world_body, flight.scenario().airframe);
  moment.T_odometry_body = state.T_world_body;
  moment.estimated_velocity_mps = state.T_world_body.linear() * state.velocity_body_mps;
  moment.estimated_rate_body_radps = state.angular_rate_body_radps;
  moment.estimated_altitude_m = state.altitude_m;
  moment.position_sigma_m = state.covariance.diagonal().segment<3>(position_block).cwiseMax(0).cwiseSqrt();
  moment.controls = flight.controls();
  moment.commanded_bank_rad = command_at(flight.plan(), moment.t_ns).bank_rad;
  return moment;
}

LogPlan plan_of(const Flight& flight) {
  const State& state = flight.state();
  // Plans speak of heights above the ground, the map of those of the odometry frame.
  const Eigen::Vector3d ground(0, 0, state.T_world_body.translation().z() - state.altitude_m);
  LogPlan plan{flight.clock().t_ns(), flight.plan().origin, {}, flight.plan().clearance_m};
  for (const PlanPoint& point : flight.plan().points)
    plan.way_odometry.push_back(point.position_world + ground);
  return plan;
}

}  // namespace

void FlightLogger::begin(const Flight& flight) {
  log_.scenario = flight.scenario();
  log_.rig = flight.rig();
  log_.obstacles = flight.obstacles();
  clearance_.emplace(flight.obstacles());
  log_.aircraft = flight.aircraft_shape();
}

void FlightLogger::on_frame(const Flight& flight) {
  const StereoFrame& frame = flight.frame();
  const auto hits = static_cast<std::int64_t>(flight.hits().size());
  digest_.add(static_cast<std::uint64_t>(frame.t_ns));
  // Images that are rendered for an observer alone must not change the digest.
  const bool detected_in = flight.scenario().perception.part().needs_images;
  digest_.add(detected_in ? bytes_of(frame.left) : std::span<const std::byte>());
  digest_.add(detected_in ? bytes_of(frame.right) : std::span<const std::byte>());
  digest_.add(static_cast<std::uint64_t>(hits));
  log_.frames.push_back({frame.t_ns, flight.clock().t_ns(), flight.truth_at(frame.t_ns).T_world_body,
                         static_cast<std::int64_t>(log_.hits_camera.size()), hits});
  for (const StereoHit& hit : flight.hits()) log_.hits_camera.push_back(hit.position_camera);
  log_.result.frames += 1;
  log_.result.detections += hits;
  follow_map(flight);
}

/// The map keeps its order and adds at its end, so that one walk through both lists tells what has gone,
/// moved and come.
void FlightLogger::follow_map(const Flight& flight) {
  const std::int64_t now_ns = flight.clock().t_ns(), t_ns = flight.frame().t_ns;
  const Eigen::Isometry3d T_true_estimated =
      flight.truth_at(t_ns).T_world_body * flight.state_at(t_ns).T_world_body.inverse();
  std::vector<std::size_t> before = std::move(remembered_);
  remembered_.clear();
  auto known = before.begin();
  for (const ObstaclePoint& point : flight.map().points()) {
    const auto is_it = [&](std::size_t index) {
      return log_.points[index].point.position_world == point.position_world;
    };
    // A point that has moved stands where the old one stood: nothing before it is skipped then.
    const auto same = point.t_ns == t_ns ? before.end() : std::find_if(known, before.end(), is_it);
    if (same != before.end()) {
      for (; known != same; ++known) log_.points[*known].to_ns = now_ns;
      remembered_.push_back(*known++);
      continue;
    }
    remembered_.push_back(log_.points.size());
    log_.points.push_back({point, T_true_estimated * point.position_world, now_ns});
    if (point.t_ns == t_ns && point.sightings == 1) ++log_.result.remembered_points;
  }
  for (; known != before.end(); ++known) log_.points[*known].to_ns = now_ns;
}

void FlightLogger::on_step(const Flight& flight) {
  if (log_.moments.empty()) begin(flight);
  digest_.add(flight.truth().T_world_body);
  if (flight.launched()) add_path(flight);
  if (flight.plan().t_ns != plan_t_ns_ && !flight.plan().points.empty()) {
    plan_t_ns_ = flight.plan().t_ns;
    log_.plans.push_back(plan_of(flight));
  }
  if (flight.clock().step() % moment_every_steps == 0) add_moment(flight);
}

void FlightLogger::add_path(const Flight& flight) {
  FlightResult& result = log_.result;
  const Eigen::Vector3d& position_world = flight.truth().T_world_body.translation();
  const double flown_m = log_.launch_ns ? (position_world - last_position_world_).norm() : 0;
  result.distance_m += flown_m;
  if (flight.in_leaves()) {
    result.leaves_s += 1.0 / physics_rate_hz;
    result.leaves_m += flown_m;
  }
  if (!log_.launch_ns) log_.launch_ns = flight.clock().t_ns();
  last_position_world_ = position_world;
  result.progress_m = std::max(result.progress_m, position_world.x());
}

void FlightLogger::add_moment(const Flight& flight) {
  const LogMoment& moment = log_.moments.emplace_back(moment_of(flight, *clearance_));
  digest_.add(moment.T_odometry_body);
  digest_.add(moment.controls.left_elevon_rad);
  digest_.add(moment.controls.right_elevon_rad);
  digest_.add(moment.controls.thrust_n);
  log_.result.minimum_clearance_m = std::min(log_.result.minimum_clearance_m, moment.clearance_m);
  if (log_.launch_ns) score(moment);
}

void FlightLogger::score(const LogMoment& moment) {
  FlightResult& result = log_.result;
  const double error_m = position_error_m(moment).norm();
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(moment.T_odometry_body.linear().transpose() * moment.T_world_body.linear()));
  position_error_sum_m_ += error_m;
  velocity_error_sum_mps_ += (moment.estimated_velocity_mps - moment.velocity_world_mps).norm();
  error_count_ += 1;
  result.position_error_max_m = std::max(result.position_error_max_m, error_m);
  result.position_error_end_m = error_m;
  result.attitude_error_max_rad = std::max(result.attitude_error_max_rad, std::abs(turn.angle()));
}

void FlightLogger::on_end(const Flight& flight) {
  if (log_.moments.back().t_ns < flight.clock().t_ns())
    log_.moments.push_back(moment_of(flight, *clearance_));
  log_.touch = flight.touch();
  const Scenario& scenario = log_.scenario;
  FlightResult& result = log_.result;
  result.scenario = scenario.name;
  result.seed = scenario.seed;
  result.sensor_seed = scenario.sensor_seed();
  result.detector = scenario.perception.detector;
  result.state_source = scenario.estimation.source;
  result.outcome = flight.outcome().value();
  double first_x_m = INFINITY;
  for (const Obstacle& obstacle : log_.obstacles)
    first_x_m = std::min({first_x_m, obstacle.from_world.x(), obstacle.to_world.x()});
  result.among_obstacles_m = std::max(0.0, result.progress_m - first_x_m);
  result.simulated_s = flight.clock().t_s();
  const double flown_s = log_.launch_ns ? result.simulated_s - seconds(*log_.launch_ns) : 0;
  if (flown_s > 0) result.mean_speed_mps = result.distance_m / flown_s;
  if (error_count_ > 0) {
    result.position_error_mean_m = position_error_sum_m_ / static_cast<double>(error_count_);
    result.velocity_error_mean_mps = velocity_error_sum_mps_ / static_cast<double>(error_count_);
  }
  const LogMoment& end = log_.moments.back();
  result.minimum_clearance_m = std::min(result.minimum_clearance_m, end.clearance_m);
  if (result.outcome == Outcome::collision && log_.touch.with != Contact::obstacle)
    result.touched = "leaves";
  else if (result.outcome == Outcome::collision)
    if (const auto touched = nearest_obstacle(end.T_world_body, scenario.airframe, log_.obstacles))
      result.touched = log_.obstacles[*touched].name;
  if (result.minimum_clearance_m < 0 && log_.touch.with == Contact::none && !scenario.forest.intangible)
    result.contradiction = fmt::format(
        "the clearance fell to {:.2f} m, and nothing was touched: the body that collides is smaller than the "
        "airframe's span_m, chord_m and positions say",
        result.minimum_clearance_m);
  count_points_on_obstacles();
  result.planner = flight.planner_counts();
  if (flight.cameras() != nullptr)
    result.renderer = flight.cameras()->renderer();
  else if (const char* tunables = std::getenv("GLIBC_TUNABLES"))
    result.renderer = std::string("no images, GLIBC_TUNABLES=") + tunables;
  result.timings = flight.stopwatch().timings();
  result.wall_s = flight.stopwatch().elapsed_s();
  result.digest = digest_.hex();
  add_loss(log_, result);
}

/// On a course of few named obstacles: the points seen on each.
void FlightLogger::count_points_on_obstacles() {
  constexpr std::size_t few = 8;
  if (log_.obstacles.size() > few) return;
  FlightResult& result = log_.result;
  for (const Obstacle& obstacle : log_.obstacles) {
    const std::int64_t points = std::ranges::count_if(log_.points, [&](const LogPoint& one) {
      return one.point.sightings == 1 && belongs_to(one.true_position_world, obstacle);
    });
    result.points_on_obstacles.emplace_back(obstacle.name, points);
    if (result.minimum_points_on_an_obstacle < 0 || points < result.minimum_points_on_an_obstacle)
      result.minimum_points_on_an_obstacle = points;
  }
}

}  // namespace understory
