#include "scenarios/flight/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

/// An image that nobody looks at is not rendered: rendering is most of a flight's cost.
bool needs_images(const Scenario& scenario, const std::vector<FlightObserver*>& observers) {
  return scenario.perception.part().needs_images ||
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

void Flight::step() {
  if (outcome_) return;
  history_.observe(truth());
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
  const std::int64_t latency_ns = nanoseconds(scenario_.cameras.latency_s);
  const std::int64_t arrival_ns = t_ns + latency_ns;
  const bool taken = computer_.will_take(arrival_ns, clock_.next_camera_t_ns() + latency_ns) ||
                     !scenario_.every_frame_arrives();
  StereoFrame frame{t_ns - scenario_.cameras.exposure_lag_ns(), {}, {}};
  if (cameras_ && taken && is_looked_at()) {
    const auto timed = stopwatch_.time("render");
    frame = cameras_->capture(truth().T_world_body, t_ns);
  }
  if (sensors_.faults().pass(frame)) computer_.send(std::move(frame), arrival_ns);
}

/// A detector that was handed over looks at all of them.
bool Flight::is_looked_at() const {
  return has_own_detector_ || scenario_.perception.part().needs_images ||
         std::ranges::any_of(observers_, &FlightObserver::wants_frame);
}

void Flight::process(StereoFrame frame) {
  frame_ = std::move(frame);
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

void Flight::advance() {
  const auto timed = stopwatch_.time("physics");
  try {
    aircraft_.step(controls_);
  } catch (const SimulationError& error) {
    throw ScenarioError(fmt::format(
        "{}: airframe: {}, {:.3f} s into the flight; the aircraft must be one that steps of 1/1200 "
        "s can follow (keys of airframe, actuators, mismatch, autopilot)",
        scenario_.name, error.what(), clock_.t_s()));
  }
  clock_.advance();
}

}  // namespace understory
