#include "planning/autopilot.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace understory {
namespace {

constexpr double predict_step_s = 0.005;

}  // namespace

Autopilot::Autopilot(const AutopilotConfig& config, const Airframe& airframe, const StereoRig& rig,
                     ObstacleDetector& detector, StateSource& state_source, Planner& planner)
    : config_(config),
      rig_(rig),
      detector_(&detector),
      state_source_(&state_source),
      model_(airframe, config.flight_model),
      planner_(&planner),
      map_(config.map),
      resightings_(config.resightings) {}

void Autopilot::change(const AutopilotConfig& config, ObstacleDetector& detector, StateSource& state_source,
                       Planner& planner, const LocalMap::Place& place) {
  config_ = config;
  detector_ = &detector;
  state_source_ = &state_source;
  planner_ = &planner;
  map_.change(config.map);
  if (!place) return;
  map_.move(place);
  plan_outdated_ = true;
}

void Autopilot::on(const Sample& sample) {
  state_source_->on(sample);
  const auto* fix = std::get_if<GpsSample>(&sample);
  if (fix != nullptr && fix->position_world_m.allFinite())
    drift_world_m_ =
        (fix->position_world_m - state_source_->state_at(fix->t_ns).T_world_body.translation()).head<2>();
  const auto* imu = std::get_if<ImuSample>(&sample);
  if (imu == nullptr) return;
  const bool strong = imu->specific_force_body_mps2.x() > config_.launch_acceleration_mps2;
  strong_samples_ = strong ? strong_samples_ + 1 : 0;
  if (launch_ns_ < 0 && strong_samples_ >= 2) launch_ns_ = imu->t_ns;
}

bool Autopilot::in_flight(std::int64_t t_ns) const {
  return launch_ns_ >= 0 && t_ns >= launch_ns_ + nanoseconds(config_.throttle_delay_s);
}

void Autopilot::on(const StereoFrame& frame) {
  const State seen = state_source_->state_at(frame.t_ns);  // the image's moment, not now
  hits_ = detector_->detect(frame);
  resightings_.insert(hits_, seen.T_world_body * rig_.T_body_camera, frame.t_ns);
  for (const Resighting& again : resightings_.completed())
    state_source_->on(
        ResightingSample{again.t_ns, again.earlier_ns, again.discrepancy_world_m, again.covariance_m2});
  map_.insert(hits_, seen.T_world_body * rig_.T_body_camera, frame.t_ns, seen.distance_flown_m);
  plan_outdated_ = plan_outdated_ || concerns_the_plan(frame.t_ns);
  map_.forget_passed(state_source_->state().T_world_body, frame.t_ns);
}

// Whether the frame of `t_ns` added a point that may change the newest plan, in force or about to be.
bool Autopilot::concerns_the_plan(std::int64_t t_ns) const {
  const Plan& plan = next_plan_due_ns_ >= 0 ? next_plan_ : plan_;
  const std::vector<ObstaclePoint>& points = map_.points();  // new ones come last
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    if (point->t_ns != t_ns || point->sightings != 1) break;
    if (planner_->concerns(*point, plan)) return true;
  }
  return false;
}

void Autopilot::replan(std::int64_t t_ns) {
  if (pilot_ != nullptr || !in_flight(t_ns) || next_plan_due_ns_ >= 0) return;
  const double period_s =
      plan_.origin == PlanOrigin::straight ? config_.straight_period_s : config_.avoiding_period_s;
  if (!plan_outdated_ && t_ns - planned_ns_ < nanoseconds(period_s)) return;
  const bool outdated = plan_outdated_ || period_s == 0;
  planned_ns_ = t_ns;
  plan_outdated_ = false;
  // A command moves the elevons one input delay later, and the plan is ready one latency later. So plan from
  // where the aircraft will be then under the commands given until then.
  const std::int64_t effective_ns =
      t_ns + nanoseconds(config_.plan_latency_s) + nanoseconds(model_.airframe().input_delay_s);
  const State& state = state_source_->state();
  FlightState start = flight_state(state);
  for (std::int64_t at_ns = state.t_ns; at_ns < effective_ns; at_ns += nanoseconds(predict_step_s))
    start = model_.advance(start, command_at(plan_, at_ns), predict_step_s);
  // The planner uses heights above the ground and, with GPS, places beside the course's own line; the map
  // uses those of the odometry frame. The two drift apart slowly.
  const double ground_m = state.T_world_body.translation().z() - state.altitude_m;
  const Eigen::Vector3d shift_world(drift_world_m_.x(), drift_world_m_.y(), -ground_m);
  start.position_world += shift_world;
  std::vector<ObstaclePoint> points = map_.trusted_points();
  for (ObstaclePoint& point : points) point.position_world += shift_world;
  const auto map_points = static_cast<std::int64_t>(points.size());
  const std::int64_t steps_before = planner_->counts().model_steps;
  next_plan_ = planner_->plan({start, effective_ns, std::move(points), state.distance_flown_m, outdated});
  const PlanCost& cost = config_.plan_cost;
  const double worked_s = cost.point_s * static_cast<double>(map_points) +
                          cost.step_s * static_cast<double>(planner_->counts().model_steps - steps_before);
  for (PlanPoint& point : next_plan_.points) point.position_world.head<2>() -= drift_world_m_;
  next_plan_due_ns_ = t_ns + nanoseconds(std::max(config_.plan_latency_s, worked_s));
  map_points_ += map_points;
  late_plans_ += worked_s > config_.plan_latency_s;
}

PlannerCounts Autopilot::counts() const {
  PlannerCounts counts = planner_->counts();
  counts.map_points = map_points_;
  counts.late_plans = late_plans_;
  return counts;
}

Controls Autopilot::controls(std::int64_t t_ns) {
  if (!in_flight(t_ns)) return {};  // on the rail: surfaces neutral, no thrust
  if (next_plan_due_ns_ >= 0 && t_ns >= next_plan_due_ns_) {
    plan_ = std::move(next_plan_);
    next_plan_due_ns_ = -1;
  }
  const std::int64_t effective_ns = t_ns + nanoseconds(model_.airframe().input_delay_s);
  const State& state = state_source_->state();
  const Controls controls = pilot_ != nullptr
                                ? pilot_->controls(t_ns, state)
                                : follow(model_, config_.follower, command_at(plan_, effective_ns), state);
  state_source_->on(ThrustSample{t_ns, controls.thrust_n});
  return controls;
}

}  // namespace understory
