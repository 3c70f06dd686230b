#include "scenarios/flight/flight_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "scenarios/flight/clearance.hpp"

namespace understory {
namespace {

/// What a person, too, would see as the obstacle: pixels of the left image.
constexpr int in_view_px = 25;
/// The frames' times apart from which pictures are missing, and an estimate's error that matters.
constexpr double gap_s = 0.1, wrong_m = 0.3;

constexpr double degrees = 57.29577951308232;

double seconds(std::int64_t t_ns) { return static_cast<double>(t_ns) * 1e-9; }

/// "left_wing_outer": "the outer left wing".
std::string words_of_part(const std::string& part) {
  if (part == "pod") return "the fuselage";
  std::vector<std::string> words{""};
  for (const char c : part) {
    if (c == '_')
      words.emplace_back();
    else
      words.back() += c;
  }
  if (words.size() == 3) std::rotate(words.begin(), words.begin() + 2, words.end());
  return fmt::format("the {}", fmt::join(words, " "));
}

double distance_m(const Eigen::Vector3d& point_world, const Obstacle& obstacle) {
  return obstacle_distance_m({point_world, point_world}, obstacle);
}

std::string outcome_sentence(const Flight& flight, const FlightStory& story) {
  const Eigen::Vector3d& place = flight.truth().T_world_body.translation();
  const Scenario& scenario = flight.scenario();
  const std::string when =
      fmt::format("at {:.2f} s, {:.1f} m from the launch", flight.clock().t_s(), place.x());
  switch (flight.outcome().value()) {
    case Outcome::goal:
      return fmt::format("It passed the goal plane at {:.0f} m after {:.2f} s.", scenario.goal_x_m(),
                         flight.clock().t_s());
    case Outcome::collision:
      return fmt::format("{} touched {} {}, {:.1f} m above the ground.", words_of_part(story.part),
                         story.touched ? flight.obstacles()[*story.touched].name : "an obstacle", when,
                         place.z());
    case Outcome::ground:
      return fmt::format("{} touched the ground {}.", words_of_part(story.part), when);
    case Outcome::time:
      return fmt::format("Its {:.1f} s were over, {:.1f} m before the goal plane.", scenario.time_limit_s,
                         scenario.goal_x_m() - place.x());
    case Outcome::out_of_bounds:
      break;
  }
  const auto beyond = [&](const char* bound, double limit_m, double at_m) {
    return fmt::format("It left the course through {} of {:.1f} m: it was at {:.2f} m {}.", bound, limit_m,
                       at_m, when);
  };
  const BandConfig& band = scenario.band;
  if (place.z() > band.maximum_altitude_m)
    return beyond("the upper bound", band.maximum_altitude_m, place.z());
  if (std::abs(place.y()) > scenario.forest.half_width_m)
    return beyond(place.y() > 0 ? "the left side" : "the right side", scenario.forest.half_width_m,
                  std::abs(place.y()));
  if (place.x() < -scenario.forest.half_width_m)
    return fmt::format("It left the course backwards: {:.1f} m behind the launch after {:.2f} s.", -place.x(),
                       flight.clock().t_s());
  return beyond("the lower bound", band.minimum_altitude_m, place.z());
}

std::optional<double> first_in_view_s(const Flight& flight, const FlightTrack& track, std::size_t obstacle) {
  if (flight.cameras() == nullptr || flight.scenario().forest.invisible) return std::nullopt;
  const auto object = static_cast<double>(object_first_obstacle + obstacle);
  for (const TrackFrame& frame : track.frames) {
    const TrueView view = flight.cameras()->true_view(frame.truth.T_world_body);
    if (cv::countNonZero(view.objects == object) >= in_view_px) return seconds(frame.t_ns);
  }
  return std::nullopt;
}

double ahead_m(const FlightTrack& track, double t_s, const Obstacle& obstacle) {
  const auto moment = std::ranges::lower_bound(track.moments, t_s, {}, &TrackMoment::t_s);
  const TrackMoment& there = moment == track.moments.end() ? track.moments.back() : *moment;
  return distance_m(there.T_world_true.translation(), obstacle);
}

void tell_of_obstacle(const Flight& flight, const FlightTrack& track, FlightStory& story) {
  const Obstacle& obstacle = flight.obstacles()[story.touched.value()];
  const double end_s = flight.clock().t_s();
  // The map belongs to the estimate, which drifts; what counts is where it has things beside the aircraft.
  const Eigen::Isometry3d T_true_estimated =
      track.moments.back().T_world_true * track.moments.back().T_world_estimated.inverse();
  const auto first_s = first_in_view_s(flight, track, *story.touched);
  if (first_s) {
    const std::string text = fmt::format("{} came into view {:.2f} s before the end, {:.1f} m away",
                                         obstacle.name, end_s - *first_s, ahead_m(track, *first_s, obstacle));
    story.events.push_back({*first_s, "in_view", text});
    story.before.push_back(text + ".");
  } else if (flight.cameras() != nullptr) {
    story.before.push_back(obstacle.name + " never came into view.");
  }

  int frames = 0;
  std::int64_t hits = 0;
  double first_hit_s = 0;
  for (const TrackFrame& frame : track.frames) {
    const auto begin = track.hits_world.begin() + static_cast<std::ptrdiff_t>(frame.first_hit);
    const auto on_it =
        std::count_if(begin, begin + static_cast<std::ptrdiff_t>(frame.hits),
                      [&](const Eigen::Vector3d& hit_world) { return belongs_to(hit_world, obstacle); });
    if (on_it > 0 && frames++ == 0) first_hit_s = seconds(frame.t_ns);
    hits += on_it;
  }
  if (frames > 0) {
    const std::string text =
        fmt::format("{} was first detected {:.2f} s before the end, {:.1f} m away", obstacle.name,
                    end_s - first_hit_s, ahead_m(track, first_hit_s, obstacle));
    story.events.push_back({first_hit_s, "detected", text});
    story.before.push_back(fmt::format("{}; {} hits in {} frames.", text, hits, frames));
  } else {
    story.before.push_back(obstacle.name + " was never detected.");
  }

  int points = 0;
  double forgotten_s = 0;
  double nearest_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d sum_world = Eigen::Vector3d::Zero();
  for (const TrackPoint& point : track.points) {
    const Eigen::Vector3d place_world = T_true_estimated * point.position_world;
    const double away_m = distance_m(place_world, obstacle);
    if (away_m > 2 * belongs_within_m) continue;
    forgotten_s = std::max(forgotten_s, point.to_s);
    if (point.to_s < end_s) continue;
    ++points;
    nearest_m = std::min(nearest_m, away_m);
    sum_world += place_world;
  }
  if (points == 0) {
    story.before.push_back(
        fmt::format("At the end the map held no point within {:.0f} m of it", 2 * belongs_within_m));
    if (forgotten_s > 0) {
      story.before.back() += fmt::format(": it had lost the last one {:.2f} s before", end_s - forgotten_s);
      story.events.push_back(
          {forgotten_s, "forgotten", fmt::format("the map lost its last point of {}", obstacle.name)});
    }
    story.before.back() += ".";
    return;
  }
  const Eigen::Vector3d off_world = sum_world / points - obstacle.from_world;
  story.before.push_back(fmt::format(
      "At the end the map held {} points for it, the nearest {:.2f} m from its surface; their middle "
      "lay {:.2f} m {} and {:.2f} m {} its axis.",
      points, std::max(0.0, nearest_m), std::abs(off_world.y()),
      off_world.y() > 0 ? "to the left" : "to the right", std::abs(off_world.x()),
      off_world.x() > 0 ? "behind" : "before"));
}

/// Frames that did not come; an estimate that no longer knows how wrong it is.
void tell_of_senses(const FlightTrack& track, double end_s, FlightStory& story) {
  double before_s = track.frames.empty() ? end_s : seconds(track.frames.front().t_ns);
  const auto tell_gap = [&](double until_s) {
    if (until_s - before_s > gap_s)
      story.events.push_back(
          {before_s, "blind",
           fmt::format("no picture reached the autopilot for {:.2f} s", until_s - before_s)});
  };
  for (const TrackFrame& frame : track.frames) {
    tell_gap(seconds(frame.t_ns));
    before_s = seconds(frame.t_ns);
  }
  tell_gap(end_s);
  const auto lost = std::ranges::find_if(track.moments, [](const TrackMoment& moment) {
    const Eigen::Array3d error_m = moment.position_error_world.array().abs();
    return (error_m > wrong_m && error_m > 3 * moment.position_sigma_world.array()).any();
  });
  if (lost != track.moments.end())
    story.events.push_back(
        {lost->t_s, "estimate",
         fmt::format("the estimate's error left its 3 sigma: {:.2f} m", lost->position_error_world.norm())});
}

/// Of an aircraft that left its band: how it moved in the last second, and what it knew of that.
void tell_of_motion(const FlightTrack& track, FlightStory& story) {
  constexpr double told_s = 1, level_rad = 0.2, wrong_height_m = 0.2;
  const TrackMoment& end = track.moments.back();
  const auto first = std::ranges::lower_bound(track.moments, end.t_s - told_s, {}, &TrackMoment::t_s);
  const auto banked = std::ranges::max_element(
      first, track.moments.end(), {}, [](const TrackMoment& moment) { return std::abs(moment.bank_rad); });
  const double risen_m = end.T_world_true.translation().z() - first->T_world_true.translation().z();
  std::string text = fmt::format("In the last {:.1f} s it {} {:.1f} m", end.t_s - first->t_s,
                                 risen_m < 0 ? "sank" : "climbed", std::abs(risen_m));
  if (std::abs(banked->bank_rad) > level_rad)
    text += fmt::format(", banked up to {:.0f} degrees to the {} ({:.0f} were commanded)",
                        degrees * std::abs(banked->bank_rad), banked->bank_rad > 0 ? "right" : "left",
                        degrees * std::abs(banked->commanded_bank_rad));
  story.before.push_back(fmt::format("{}, and its speed went from {:.1f} to {:.1f} m/s.", text,
                                     first->speed_mps, end.speed_mps));
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (const TrackPlan& plan : track.plans)
    if (plan.from_s >= end.t_s - told_s)
      for (const Eigen::Vector3d& point : plan.way_world) {
        lowest_m = std::min(lowest_m, point.z());
        highest_m = std::max(highest_m, point.z());
      }
  if (lowest_m <= highest_m)
    story.before.push_back(
        fmt::format("The plans of that time led to heights from {:.1f} to {:.1f} m.", lowest_m, highest_m));
  const double believed_m = end.estimated_altitude_m - end.T_world_true.translation().z();
  if (std::abs(believed_m) > wrong_height_m)
    story.before.push_back(fmt::format("It believed itself {:.1f} m {} than it was.", std::abs(believed_m),
                                       believed_m > 0 ? "higher" : "lower"));
}

void tell_of_plans(const FlightTrack& track, FlightStory& story) {
  bool falls_back = false;
  for (const TrackPlan& plan : track.plans) {
    const bool now = plan.origin == PlanOrigin::fallback;
    if (now && !falls_back)
      story.events.push_back({plan.from_s, "fallback", "the planner found no free way and fell back"});
    falls_back = now;
  }
  if (track.plans.empty()) return;
  const TrackPlan& last = track.plans.back();
  if (std::isfinite(last.clearance_m))
    story.before.push_back(
        last.clearance_m > 0
            ? fmt::format("The plan in force ({}) left {:.2f} m to what the planner believed was there.",
                          word_for(last.origin), last.clearance_m)
            : fmt::format("The plan in force ({}) led through what the planner believed was there.",
                          word_for(last.origin)));
  else
    story.before.push_back(
        fmt::format("The plan in force ({}) knew of nothing near.", word_for(last.origin)));
}

}  // namespace

FlightStory story_of(const Flight& flight, const FlightTrack& track) {
  FlightStory story;
  const double end_s = flight.clock().t_s();
  const Touch touch = flight.touch();
  if (touch.with != Contact::none) {
    story.part = touch.part;
    story.impact_world = touch.position_world;
  }
  if (flight.outcome() == Outcome::collision)
    story.touched =
        nearest_obstacle(flight.truth().T_world_body, flight.scenario().airframe, flight.obstacles());
  story.outcome = outcome_sentence(flight, story);
  if (!story.outcome.empty()) story.outcome.front() = static_cast<char>(std::toupper(story.outcome.front()));
  if (track.launch_s > 0) story.events.push_back({track.launch_s, "launch", "left the catapult"});
  for (const FaultConfig& fault : flight.scenario().faults)
    if (fault.at_s <= end_s)
      story.events.push_back(
          {fault.at_s, "fault",
           fmt::format("fault: {} {}", faulty_sensor_names[static_cast<std::size_t>(fault.sensor)].first,
                       fault_kind_names[static_cast<std::size_t>(fault.kind)].first)});
  if (story.touched) tell_of_obstacle(flight, track, story);
  tell_of_senses(track, end_s, story);
  if (flight.outcome() == Outcome::out_of_bounds || flight.outcome() == Outcome::ground)
    tell_of_motion(track, story);
  if (flight.outcome() != Outcome::goal) tell_of_plans(track, story);
  std::string outcome(word_for(flight.outcome().value()));
  std::ranges::replace(outcome, '_', ' ');
  story.events.push_back({end_s, "outcome", outcome});
  std::ranges::stable_sort(story.events, {}, &FlightEvent::t_s);
  return story;
}

}  // namespace understory
