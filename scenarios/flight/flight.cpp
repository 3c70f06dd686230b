#include "scenarios/flight/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "planning/path_follower.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/ideal_parts.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

/// An image that nobody looks at is not rendered: rendering is most of a flight's cost.
bool needs_images(const Scenario& scenario, const std::vector<FlightObserver*>& observers) {
  const bool never_looks =
      !scenario.ideal.hits.empty() && (is_ideal(scenario, "detection") || is_ideal(scenario, "sight"));
  return (scenario.perception.part().needs_images && !never_looks) ||
         std::ranges::any_of(observers, [](const auto* observer) { return observer->needs_images(); });
}

}  // namespace

Flight::Flight(const Scenario& scenario, const FlightMachine& machine, std::vector<FlightObserver*> observers,
               FlightParts parts)
    : scenario_(scenario),
      observers_(std::move(observers)),
      has_own_detector_(parts.detector != nullptr),
      rig_(rig_of(scenario, machine.models_folder)),
      world_(stopwatch_.time("setup", [&] { return world_of(scenario, machine.models_folder); })),
      aircraft_(aircraft_of(scenario, world_)),
      cameras_(has_own_detector_ || needs_images(scenario, observers_)
                   ? stopwatch_.time("context",
                                     [&] { return cameras_of(scenario, world_, rig_, machine.renderer); })
                   : nullptr),
      sensors_(scenario),
      drops_(scenario.cameras.drop_probability, seed_for(scenario.sensor_seed(), "camera_drops")),
      computer_(nanoseconds(scenario.perception.cost_s())),
      plans_model_(scenario.airframe, scenario.autopilot.flight_model),
      parts_(with_rest(std::move(parts))),
      autopilot_(autopilot_config_of(scenario, rig_.rig), scenario.airframe, rig_.rig, *parts_.detector,
                 *parts_.state_source, *parts_.planner),
      referee_(scenario),
      clock_(scenario) {
  if (parts_.pilot) autopilot_.hand_over(*parts_.pilot);
  if (!world_.woods) return;
  std::vector<WingBox> boxes;
  for (const AircraftPart& part : aircraft_.shape().parts)
    boxes.push_back({Eigen::Isometry3d(Eigen::Translation3d(part.centre_body)), part.half_size_m});
  leaves_.emplace(world_.woods->leaf_cards, std::move(boxes));
}

/// Those that were not handed over are the scenario's.
FlightParts Flight::with_rest(FlightParts parts) const {
  if (!parts.detector) parts.detector = detector_of(scenario_, rig_, world_.obstacles, history_);
  if (!parts.state_source) parts.state_source = state_source_of(scenario_, rig_, world_.obstacles, history_);
  if (!parts.planner) parts.planner = planner_of(scenario_);
  if (!parts.pilot) parts.pilot = pilot_of(scenario_);
  return parts;
}

bool Flight::in_leaves() const { return leaves_ && leaves_->touches(truth().T_world_body); }

/// The scenario's ideal parts take the place of its own, and noise is drawn anew.
void Flight::begin_ideal() {
  ideal_ = true;
  const std::uint64_t redraw = scenario_.ideal.redraw;
  if (redraw != 0) {
    sensors_.redraw(redraw);
    drops_ = FrameDrops(scenario_.cameras.drop_probability, seed_for(redraw, "camera_drops"));
    if (cameras_) cameras_->redraw({seed_for(redraw, "cameras"), seed_for(redraw, "camera_shot_noise")});
  }
  if (is_ideal(scenario_, "map")) forgets_ = false;
  const AutopilotConfig config = autopilot_config();
  if (is_ideal(scenario_, "search") && scenario_.autopilot.method != "sst") {
    Scenario ours = scenario_;
    ours.autopilot.method = "sst";  // another planner may not search at all, or in its own way
    parts_.planner = planner_of(ours);
  }
  if (redraw != 0 || is_ideal(scenario_, "search"))
    parts_.planner->change(config.planner,
                           seed_for(redraw != 0 ? redraw : scenario_.planner_seed(), "planner"));
  if (auto ideal = ideal_detector(scenario_, rig_.rig, world_.obstacles, history_)) {
    if (auto* known = dynamic_cast<KnownDetector*>(parts_.detector.get()))
      known->replace(std::move(ideal));
    else
      parts_.detector = std::move(ideal);
  }
  if (is_ideal(scenario_, "state")) {
    auto source = std::make_unique<TrueState>(history_, state().distance_flown_m);
    if (const auto& imu = newest<ImuSample>()) source->on(*imu);
    parts_.state_source = std::move(source);
  }
  if (is_ideal(scenario_, "latency")) {
    computer_.hurry(clock_.t_ns());
    last_arrival_ns_ = clock_.t_ns();
  }
  LocalMap::Place place;
  if (is_ideal(scenario_, "state") || is_ideal(scenario_, "detection") || is_ideal(scenario_, "sight"))
    place = [this](const ObstaclePoint& point) { return place_of(point); };
  autopilot_.change(config, *parts_.detector, *parts_.state_source, *parts_.planner, place);
}

/// An ideal state moves remembered points to their true places; ideal detection and sight forget those on no
/// obstacle.
std::optional<Eigen::Vector3d> Flight::place_of(const ObstaclePoint& point) const {
  const auto frame = T_true_estimated_.find(point.t_ns);
  if (frame == T_true_estimated_.end()) return point.position_world;
  const Eigen::Vector3d true_place = frame->second * point.position_world;
  const auto is_on = [&](const Obstacle& obstacle) { return belongs_to(true_place, obstacle); };
  const bool knows = is_ideal(scenario_, "detection") || is_ideal(scenario_, "sight");
  if (knows && std::ranges::none_of(world_.obstacles, is_on)) return std::nullopt;
  return is_ideal(scenario_, "state") ? true_place : point.position_world;
}

bool Flight::is_ideal_now(std::string_view part) const { return ideal_ && is_ideal(scenario_, part); }

std::int64_t Flight::latency_ns(std::int64_t t_ns) const {
  if (is_ideal_now("latency")) return 0;
  const auto delay_s = faults().value(FaultySensor::camera, FaultKind::delay, t_ns);
  return nanoseconds(scenario_.cameras.latency_s + delay_s.value_or(0));
}

AutopilotConfig Flight::autopilot_config() const {
  AutopilotConfig config = autopilot_config_of(scenario_, rig_.rig);
  if (ideal_) config = with_ideal_parts(config, scenario_);
  if (forgets_) config.map.max_age_s = 0;
  return config;
}

void Flight::follow_map_fault() {
  const bool forgets =
      faults().has(FaultySensor::map, FaultKind::dropout, clock_.t_ns()) && !is_ideal_now("map");
  if (forgets == forgets_) return;
  forgets_ = forgets;
  autopilot_.change(autopilot_config(), *parts_.detector, *parts_.state_source, *parts_.planner, nullptr);
}

void Flight::step() {
  if (outcome_) return;
  history_.observe(truth());
  if (!ideal_ && scenario_.ideal.acts() && clock_.t_ns() >= nanoseconds(scenario_.ideal.from_s))
    begin_ideal();
  follow_map_fault();
  sense();
  expose();
  while (std::optional<StereoFrame> frame = computer_.next_frame(clock_.t_ns())) process(std::move(*frame));
  act();
  tell(&FlightObserver::on_step);
  const bool stopped_by_leaves = scenario_.world.woods.leaves_end_flight && in_leaves();
  outcome_ =
      referee_.outcome_at(truth(), stopped_by_leaves ? Contact::obstacle : aircraft_.contact(), launched());
  if (outcome_)
    tell(&FlightObserver::on_end);
  else
    advance();
}

void Flight::sense() {
  const auto timed = stopwatch_.time("estimate");
  sensors_.deliver(clock_, truth(), autopilot_);
}

/// A frame reaches the autopilot's computer one latency later. A busy computer drops frames, and these need
/// not be rendered.
void Flight::expose() {
  const std::int64_t t_ns = clock_.t_ns();
  if (cameras_) cameras_->observe(truth().T_world_body, t_ns);
  if (!clock_.camera() || drops_.next()) return;
  const std::int64_t arrival_ns = std::max(t_ns + latency_ns(t_ns), last_arrival_ns_);
  last_arrival_ns_ = arrival_ns;
  const std::int64_t next_t_ns = clock_.next_camera_t_ns();
  const bool taken =
      computer_.will_take(arrival_ns, next_t_ns + latency_ns(next_t_ns)) || !scenario_.every_frame_arrives();
  StereoFrame frame{t_ns - scenario_.cameras.exposure_lag_ns(), {}, {}};
  if (cameras_ && taken && is_looked_at()) {
    const auto timed = stopwatch_.time("render");
    frame = cameras_->capture(truth().T_world_body, t_ns);
  }
  if (sensors_.faults().pass(frame)) computer_.send(std::move(frame), arrival_ns, taken);
}

/// A detector that was handed over looks at all of them.
bool Flight::is_looked_at() const {
  if (std::ranges::any_of(observers_, &FlightObserver::wants_frame)) return true;
  // An automatic exposure depends on the frames before, and so does a camera that freezes.
  const bool is_known =
      !scenario_.ideal.hits.empty() && !ideal_ && scenario_.cameras.auto_exposure_s == 0 &&
      std::ranges::find(scenario_.faults, FaultKind::freeze, &FaultConfig::kind) == scenario_.faults.end();
  const bool by_truth = is_ideal_now("detection") || is_ideal_now("sight");
  return !is_known && !by_truth && (has_own_detector_ || scenario_.perception.part().needs_images);
}

void Flight::process(StereoFrame frame) {
  frame_ = std::move(frame);
  if (!ideal_ && scenario_.ideal.acts())
    T_true_estimated_[frame_.t_ns] =
        truth_at(frame_.t_ns).T_world_body * state_at(frame_.t_ns).T_world_body.inverse();
  {
    const auto timed = stopwatch_.time("detect");
    autopilot_.on(frame_);
  }
  tell(&FlightObserver::on_frame);
}

void Flight::act() {
  if (clock_.replan()) {
    const auto timed = stopwatch_.time("replan");
    autopilot_.replan(clock_.t_ns());
  }
  if (clock_.imu()) {
    const auto timed = stopwatch_.time("control");
    controls_ = autopilot_.controls(clock_.t_ns());
  }
}

void Flight::tell(void (FlightObserver::*event)(const Flight&)) {
  for (FlightObserver* observer : observers_) {
    const auto timed = stopwatch_.time(observer->stage());
    (observer->*event)(*this);
  }
}

/// As the planner's own model says.
void Flight::follow_plan() {
  const Truth& now = truth();
  const Eigen::Matrix3d R_body_world = now.T_world_body.linear().transpose();
  if (!carried_)
    carried_ = flight_state(now.T_world_body, R_body_world * now.velocity_world_mps,
                            now.angular_rate_body_radps, now.wind_world_mps.head<2>());
  carried_->wind_world_mps = now.wind_world_mps.head<2>();
  carried_ = plans_model_.advance(*carried_, command_at(plan(), clock_.t_ns()), 1.0 / physics_rate_hz);
  const Eigen::Isometry3d pose = pose_of(*carried_);
  const Eigen::AngleAxisd turned(R_body_world * pose.linear());
  Eigen::Vector3d velocity_world_mps = carried_->speed_mps * flight_direction_world(*carried_);
  velocity_world_mps.head<2>() += carried_->wind_world_mps;
  aircraft_.carry(pose, velocity_world_mps, turned.angle() * physics_rate_hz * turned.axis(), controls_);
}

Controls Flight::controls_in_force() const {
  Controls controls = controls_;
  if (const auto share = faults().value(FaultySensor::elevons, FaultKind::weaken, clock_.t_ns())) {
    controls.left_elevon_rad *= *share;
    controls.right_elevon_rad *= *share;
  }
  return controls;
}

void Flight::advance() {
  const auto timed = stopwatch_.time("physics");
  try {
    if (is_ideal_now("tracking") && launched() && !plan().points.empty())
      follow_plan();
    else
      aircraft_.step(controls_in_force());
  } catch (const SimulationError& error) {
    throw ScenarioError(fmt::format(
        "{}: airframe: {}, {:.3f} s into the flight; the aircraft must be one that steps of 1/1200 "
        "s can follow (keys of airframe, actuators, mismatch, autopilot)",
        scenario_.name, error.what(), clock_.t_s()));
  }
  clock_.advance();
}

}  // namespace understory
