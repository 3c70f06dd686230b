#include "scenarios/flight/flight_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/obstacle_view.hpp"
#include "scenarios/parts/oracles.hpp"

namespace understory {
namespace {

/// What a person, too, would see as the obstacle: pixels of the left image.
constexpr int in_view_px = 25;
/// The frames' times apart from which pictures are missing, and an estimate's error that matters.
constexpr double gap_s = 0.1, wrong_m = 0.3;

constexpr double degrees = 57.29577951308232;

/// "left_wing_outer": "the outer left wing".
std::string words_of_part(const std::string& part) {
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

std::string outcome_sentence(const FlightLog& log) {
  const Scenario& scenario = log.scenario;
  const LogMoment& end = log.moments.back();
  const Eigen::Vector3d place = end.T_world_body.translation();
  const std::string when = fmt::format("at {:.2f} s, {:.1f} m from the launch", seconds(end.t_ns), place.x());
  switch (log.result.outcome) {
    case Outcome::goal:
      return fmt::format("It passed the goal plane at {:.0f} m after {:.2f} s.", scenario.goal_x_m(),
                         seconds(end.t_ns));
    case Outcome::collision:
      return fmt::format("{} touched {} {}, {:.1f} m above the ground.", words_of_part(log.touch.part),
                         log.result.touched.empty() ? "an obstacle" : log.result.touched, when, place.z());
    case Outcome::ground:
      return fmt::format("{} touched the ground {}.", words_of_part(log.touch.part), when);
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
  const double half_width_m = scenario.forest.half_width_m;
  const std::string_view bound = bound_left(log);
  if (bound == "upper") return beyond("the upper bound", band.maximum_altitude_m, place.z());
  if (bound == "left" || bound == "right")
    return beyond(bound == "left" ? "the left side" : "the right side", half_width_m, std::abs(place.y()));
  if (bound == "back")
    return fmt::format("It left the course backwards: {:.1f} m behind the launch after {:.2f} s.", -place.x(),
                       seconds(end.t_ns));
  return beyond("the lower bound", band.minimum_altitude_m, place.z());
}

// ---- of the obstacle that was hit ----

std::optional<double> first_in_view_s(const FlightLog& log, std::size_t obstacle) {
  for (const LogFrame& frame : log.frames)
    if (pixels_in_view(log, frame.t_ns, frame.T_world_body, obstacle, in_view_px) >= in_view_px)
      return seconds(frame.t_ns);
  return std::nullopt;
}

double away_m(const FlightLog& log, double t_s, const Obstacle& obstacle) {
  const auto moment =
      std::ranges::lower_bound(log.moments, t_s, {}, [](const LogMoment& m) { return seconds(m.t_ns); });
  const LogMoment& there = moment == log.moments.end() ? log.moments.back() : *moment;
  return distance_m(there.T_world_body.translation(), obstacle);
}

/// Intervals of depth within which the pushbroom can match something; none for other detectors.
std::vector<DepthInterval> intervals_of(const FlightLog& log) {
  const StereoRig& rig = log.rig.rig;
  std::vector<DepthInterval> intervals;
  for (const double depth_m : compared_depths_m(log))
    intervals.push_back(rig.depths_around(std::round(rig.disparity_px(depth_m)), 0.5));
  return intervals;
}

bool was_in_view_at_depth(const FlightLog& log, std::size_t index,
                          const std::vector<DepthInterval>& intervals) {
  return std::ranges::any_of(log.frames, [&](const LogFrame& frame) {
    const Eigen::Isometry3d T_world_camera = frame.T_world_body * log.rig.rig.T_body_camera;
    const Eigen::Vector3d place_world = nearest_place(T_world_camera.translation(), log.obstacles[index]);
    const double depth_m = (T_world_camera.inverse() * place_world).z();
    const auto holds = [&](const DepthInterval& one) {
      return one.near_m <= depth_m && depth_m <= one.far_m;
    };
    return std::ranges::any_of(intervals, holds) &&
           pixels_in_view(log, frame.t_ns, frame.T_world_body, index, in_view_px) >= in_view_px;
  });
}

void find_hits(const FlightLog& log, const Obstacle& obstacle, ObstacleStory& story) {
  for (const LogFrame& frame : log.frames) {
    std::int64_t on_it = 0;
    for (std::int64_t hit = 0; hit < frame.hits; ++hit)
      on_it += belongs_to(hit_world(log, frame, hit), obstacle);
    if (on_it > 0 && !story.detected_s) story.detected_s = seconds(frame.t_ns);
    story.frames_with_hits += on_it > 0;
    story.hits += on_it;
  }
  if (story.detected_s) story.detected_m = away_m(log, *story.detected_s, obstacle);
}

/// The map belongs to the estimate, which drifts; what counts is where it has things beside the aircraft.
void find_points(const FlightLog& log, const Obstacle& obstacle, ObstacleStory& story) {
  const LogMoment& end = log.moments.back();
  const Eigen::Isometry3d T_world_odometry = end.T_world_body * end.T_odometry_body.inverse();
  Eigen::Vector3d sum_world = Eigen::Vector3d::Zero();
  std::int64_t lost_ns = -1;
  story.nearest_point_m = std::numeric_limits<double>::infinity();
  for (const LogPoint& one : log.points) {
    const Eigen::Vector3d place_world = T_world_odometry * one.point.position_world;
    const double surface_m = distance_m(place_world, obstacle);
    if (surface_m > 2 * belongs_within_m) continue;
    if (one.to_ns != still_there_ns) {
      lost_ns = std::max(lost_ns, one.to_ns);
      continue;
    }
    ++story.points;
    story.nearest_point_m = std::min(story.nearest_point_m, surface_m);
    sum_world += place_world;
  }
  if (story.points == 0) {
    if (lost_ns >= 0) story.forgotten_s = seconds(lost_ns);
    return;
  }
  const Eigen::Vector3d middle_world = sum_world / static_cast<double>(story.points);
  story.points_off_world = middle_world - nearest_place(middle_world, obstacle);
}

ObstacleStory story_of_obstacle(const FlightLog& log, std::size_t index) {
  const Obstacle& obstacle = log.obstacles[index];
  ObstacleStory story;
  story.obstacle = index;
  story.has_camera = !log.result.renderer.empty() && !log.result.renderer.starts_with("no images") &&
                     !log.scenario.forest.invisible;
  if (story.has_camera) story.in_view_s = first_in_view_s(log, index);
  if (story.in_view_s) story.in_view_m = away_m(log, *story.in_view_s, obstacle);
  find_hits(log, obstacle, story);
  if (const std::vector<DepthInterval> intervals = intervals_of(log); story.has_camera && !intervals.empty())
    story.in_view_at_depth = was_in_view_at_depth(log, index, intervals);
  find_points(log, obstacle, story);
  return story;
}

/// "0.21 m left of, 0.31 m in front of and 0.40 m below", of what is worth saying.
std::string words_of_offset(const Eigen::Vector3d& off_world) {
  constexpr double worth_m = 0.005;
  std::vector<std::string> words;
  const auto add = [&](double by_m, const char* more, const char* less) {
    if (std::abs(by_m) >= worth_m)
      words.push_back(fmt::format("{:.2f} m {}", std::abs(by_m), by_m > 0 ? more : less));
  };
  add(off_world.y(), "left of", "right of");
  add(off_world.x(), "behind", "in front of");
  add(off_world.z(), "above", "below");
  if (words.empty()) return "less than a centimetre from";
  const std::string last = words.back();
  words.pop_back();
  return words.empty() ? last : fmt::format("{} and {}", fmt::join(words, ", "), last);
}

void tell_of_obstacle(const FlightLog& log, const ObstacleStory& told, FlightStory& story) {
  const Obstacle& obstacle = log.obstacles[told.obstacle];
  const double end_s = seconds(log.moments.back().t_ns);
  if (told.in_view_s) {
    const std::string text = fmt::format("{} came into view {:.2f} s before the end, {:.1f} m away",
                                         obstacle.name, end_s - *told.in_view_s, told.in_view_m);
    story.events.push_back({*told.in_view_s, "in_view", text});
    story.before.push_back(text + ".");
  } else if (told.has_camera) {
    story.before.push_back(obstacle.name + " never came into view.");
  }
  if (told.detected_s) {
    const std::string text = fmt::format("{} was first detected {:.2f} s before the end, {:.1f} m away",
                                         obstacle.name, end_s - *told.detected_s, told.detected_m);
    story.events.push_back({*told.detected_s, "detected", text});
    story.before.push_back(
        fmt::format("{}; {} detections in {} frames.", text, told.hits, told.frames_with_hits));
  } else {
    story.before.push_back(
        obstacle.name +
        (told.in_view_at_depth == false
             ? " was never detected: it was not in view while it stood at the detector's depth."
             : " was never detected."));
  }
  if (told.points > 0) {
    story.before.push_back(fmt::format(
        "At the end the map held {} points within {:.0f} m of it, the nearest {:.2f} m from its "
        "surface. On average they lay {} its {}.",
        told.points, 2 * belongs_within_m, std::max(0.0, told.nearest_point_m),
        words_of_offset(told.points_off_world), obstacle.kind == ObstacleKind::wall ? "face" : "axis"));
    return;
  }
  std::string text =
      fmt::format("At the end the map held no point within {:.0f} m of it", 2 * belongs_within_m);
  if (told.forgotten_s) {
    text += fmt::format(": it had lost the last one {:.2f} s before", end_s - *told.forgotten_s);
    story.events.push_back(
        {*told.forgotten_s, "forgotten", fmt::format("the map lost its last point of {}", obstacle.name)});
  }
  story.before.push_back(text + ".");
}

// ---- of everything else ----

/// Frames that did not come; an estimate that no longer knows how wrong it is.
void tell_of_senses(const FlightLog& log, FlightStory& story) {
  const double end_s = seconds(log.moments.back().t_ns);
  double before_s = log.frames.empty() ? end_s : seconds(log.frames.front().t_ns);
  const auto tell_gap = [&](double until_s) {
    if (until_s - before_s > gap_s)
      story.events.push_back(
          {before_s, "blind",
           fmt::format("no picture reached the autopilot for {:.2f} s", until_s - before_s)});
    before_s = until_s;
  };
  for (const LogFrame& frame : log.frames) tell_gap(seconds(frame.t_ns));
  tell_gap(end_s);
  const auto lost = std::ranges::find_if(log.moments, [](const LogMoment& moment) {
    const Eigen::Array3d error_m = position_error_m(moment).array().abs();
    return (error_m > wrong_m && error_m > 3 * moment.position_sigma_m.array()).any();
  });
  if (lost != log.moments.end())
    story.events.push_back(
        {seconds(lost->t_ns), "estimate",
         fmt::format("the estimate's error left its 3 sigma: {:.2f} m", position_error_m(*lost).norm())});
}

/// Of an aircraft that left its band: how it moved in the last second, and what it knew of that.
void tell_of_motion(const FlightLog& log, FlightStory& story) {
  constexpr std::int64_t told_ns = 1'000'000'000;
  constexpr double level_rad = 0.2, wrong_height_m = 0.2;
  const LogMoment& end = log.moments.back();
  const auto first = std::ranges::lower_bound(log.moments, end.t_ns - told_ns, {}, &LogMoment::t_ns);
  const auto banked = std::ranges::max_element(first, log.moments.end(), {}, [](const LogMoment& moment) {
    return std::abs(bank_rad(moment.T_world_body));
  });
  const double bank = bank_rad(banked->T_world_body);
  const double height_m = end.T_world_body.translation().z();
  const double risen_m = height_m - first->T_world_body.translation().z();
  std::string text = fmt::format("In the last {:.1f} s it {} {:.1f} m", seconds(end.t_ns - first->t_ns),
                                 risen_m < 0 ? "sank" : "climbed", std::abs(risen_m));
  if (std::abs(bank) > level_rad)
    text += fmt::format(", banked up to {:.0f} degrees to the {} ({:.0f} were commanded at that moment)",
                        degrees * std::abs(bank), bank > 0 ? "right" : "left",
                        degrees * std::abs(banked->commanded_bank_rad));
  story.before.push_back(fmt::format("{}, and its speed went from {:.1f} to {:.1f} m/s.", text,
                                     first->velocity_world_mps.norm(), end.velocity_world_mps.norm()));
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (const LogPlan& plan : log.plans)
    if (plan.t_ns >= end.t_ns - told_ns)
      for (const Eigen::Vector3d& place : plan.way_odometry) {
        lowest_m = std::min(lowest_m, place.z());
        highest_m = std::max(highest_m, place.z());
      }
  if (lowest_m <= highest_m)
    story.before.push_back(
        fmt::format("The plans of that time led to heights from {:.1f} to {:.1f} m.", lowest_m, highest_m));
  const double believed_m = end.estimated_altitude_m - height_m;
  if (std::abs(believed_m) > wrong_height_m)
    story.before.push_back(fmt::format("It believed itself {:.1f} m {} than it was.", std::abs(believed_m),
                                       believed_m > 0 ? "higher" : "lower"));
}

constexpr std::string_view words_for(PlanOrigin origin) {
  constexpr std::string_view words[] = {"straight on", "on a new manoeuvre", "on a plan made before",
                                        "on an emergency manoeuvre, since it had found no free way"};
  return words[static_cast<std::size_t>(origin)];
}

void tell_of_plans(const FlightLog& log, FlightStory& story) {
  bool falls_back = false;
  for (const LogPlan& plan : log.plans) {
    const bool now = plan.origin == PlanOrigin::fallback;
    if (now && !falls_back)
      story.events.push_back(
          {seconds(plan.t_ns), "fallback", "the planner found no free way and chose an emergency manoeuvre"});
    falls_back = now;
  }
  if (log.plans.empty()) return;
  const LogPlan& last = log.plans.back();
  const std::string way = fmt::format("At the end it flew {}.", words_for(last.origin));
  if (!std::isfinite(last.clearance_m))
    story.before.push_back(way + " The map held nothing near its way.");
  else if (last.clearance_m > 0)
    story.before.push_back(
        fmt::format("{} It was to keep {:.2f} m clear of all that the map held.", way, last.clearance_m));
  else
    story.before.push_back(way + " It led through what the map held.");
}

}  // namespace

std::vector<double> compared_depths_m(const FlightLog& log) {
  const auto& depths_m = log.scenario.perception.part().depths_m;
  return depths_m ? depths_m(log.scenario, log.rig.rig) : std::vector<double>{};
}

std::string_view bound_left(const FlightLog& log) {
  const Eigen::Vector3d place = log.moments.back().T_world_body.translation();
  const double half_width_m = log.scenario.forest.half_width_m;
  if (place.z() > log.scenario.band.maximum_altitude_m) return "upper";
  if (log.scenario.is_long()) return "lower";  // its sides end no flight
  if (std::abs(place.y()) > half_width_m) return place.y() > 0 ? "left" : "right";
  return place.x() < -half_width_m ? "back" : "lower";
}

void add_loss(const FlightLog& log, FlightResult& result) {
  if (result.outcome == Outcome::goal) return;
  if (result.outcome == Outcome::out_of_bounds) result.left_through = bound_left(log);
  result.touched_by = log.touch.part;
  if (!log.plans.empty()) {
    result.last_plan = word_for(log.plans.back().origin);
    result.last_plan_clearance_m = log.plans.back().clearance_m;
  }
  const auto touched = std::ranges::find(log.obstacles, result.touched, &Obstacle::name);
  if (touched == log.obstacles.end()) return;
  const ObstacleStory story =
      story_of_obstacle(log, static_cast<std::size_t>(touched - log.obstacles.begin()));
  const double end_s = seconds(log.moments.back().t_ns);
  if (story.in_view_s) {
    result.in_view_m = story.in_view_m;
    result.in_view_s = end_s - *story.in_view_s;
  }
  if (story.detected_s) {
    result.detected_m = story.detected_m;
    result.detected_s = end_s - *story.detected_s;
  }
  result.points_of_touched = story.points;
  if (story.points > 0) result.points_off_m = story.points_off_world.head<2>().norm();
}

FlightStory story_of(const FlightLog& log) {
  FlightStory story;
  const Outcome outcome = log.result.outcome;
  const double end_s = seconds(log.moments.back().t_ns);
  story.outcome = outcome_sentence(log);
  story.outcome.front() = static_cast<char>(std::toupper(story.outcome.front()));
  if (log.launch_ns) story.events.push_back({seconds(*log.launch_ns), "launch", "left the catapult"});
  for (const FaultConfig& fault : log.scenario.faults)
    if (fault.at_s <= end_s)
      story.events.push_back(
          {fault.at_s, "fault",
           fmt::format("fault: {} {}", faulty_sensor_names[static_cast<std::size_t>(fault.sensor)].first,
                       fault_kind_names[static_cast<std::size_t>(fault.kind)].first)});
  const auto touched = std::ranges::find(log.obstacles, log.result.touched, &Obstacle::name);
  if (outcome == Outcome::collision && touched != log.obstacles.end()) {
    story.touched = story_of_obstacle(log, static_cast<std::size_t>(touched - log.obstacles.begin()));
    tell_of_obstacle(log, *story.touched, story);
  }
  tell_of_senses(log, story);
  if (outcome == Outcome::out_of_bounds || outcome == Outcome::ground) tell_of_motion(log, story);
  if (outcome != Outcome::goal) tell_of_plans(log, story);
  std::string word(word_for(outcome));
  std::ranges::replace(word, '_', ' ');
  story.events.push_back({end_s, "outcome", word});
  std::ranges::stable_sort(story.events, {}, &FlightEvent::t_s);
  return story;
}

}  // namespace understory
