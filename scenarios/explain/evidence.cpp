#include "scenarios/explain/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight_story.hpp"

namespace understory {
namespace {

constexpr std::int64_t lately_ns = 1'500'000'000;  ///< before the end: what can have mattered
constexpr double short_s = 1, wrong_m = 0.3, beside_m = 0.1, late_s = 0.03;
constexpr double planned_s = 0.3, unplanned_m = 0.1;
constexpr std::size_t many_false = 10;

std::int64_t end_ns(const FlightLog& log) { return log.moments.back().t_ns; }

/// A sensor of the schedule that had failed by the end; its words.
std::string failed_sensors(const FlightLog& log) {
  std::vector<std::string> words;
  for (const FaultConfig& fault : log.scenario.faults) {
    const bool is_sensor = fault.sensor != FaultySensor::camera && fault.sensor != FaultySensor::elevons &&
                           fault.sensor != FaultySensor::map;
    if (is_sensor && fault.at_s < seconds(end_ns(log)))
      words.push_back(fmt::format("{} {} at {:.2f} s",
                                  faulty_sensor_names[static_cast<std::size_t>(fault.sensor)].first,
                                  fault_kind_names[static_cast<std::size_t>(fault.kind)].first, fault.at_s));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

Evidence of_false_points(const FlightLog& log) {
  std::size_t wrong = 0, all = 0;
  for (const LogPoint& one : log.points) {
    if (one.from_ns < end_ns(log) - lately_ns || one.point.sightings > 1) continue;
    ++all;
    wrong += std::ranges::none_of(log.obstacles, [&](const Obstacle& obstacle) {
      return belongs_to(one.true_position_world, obstacle);
    });
  }
  return {"false obstacle", "detection", wrong >= many_false && 2 * wrong > all,
          fmt::format("In the last {:.1f} s {} of {} new points lay on no obstacle.", 1e-9 * lately_ns, wrong,
                      all)};
}

/// Of what was touched. Where the log shows no fault of a part, the part's first entry gives the words.
std::vector<Evidence> of_obstacle(const ObstacleStory& touched, const FlightLog& log) {
  const std::string& name = log.obstacles[touched.obstacle].name;
  const bool was_in_view = touched.in_view_s.has_value(), was_detected = touched.detected_s.has_value();
  const double end_s = seconds(end_ns(log));
  std::vector<Evidence> all;
  // A detector that draws no images knows no view.
  const bool was_at_depth = !touched.has_camera || (was_in_view && touched.in_view_at_depth != false);
  const double ahead_s = was_detected ? end_s - *touched.detected_s : 0;
  all.push_back({"seen too late", "sight", was_detected && ahead_s < short_s,
                 was_detected ? fmt::format("{} was first detected {:.2f} s before the end, {:.1f} m away.",
                                            name, ahead_s, touched.detected_m)
                              : fmt::format("{} was never detected.", name)});
  all.push_back({"never in view", "sight", !was_at_depth,
                 fmt::format("{} was {}in view at a depth that the detector looks at.", name,
                             was_at_depth ? "" : "never ")});
  all.push_back({"not detected", "detection", was_at_depth && touched.frames_with_hits < 3,
                 fmt::format("{} was detected in {} frames, with {} hits.", name, touched.frames_with_hits,
                             touched.hits)});
  all.push_back({"forgotten", "map", was_detected && (touched.forgotten_s.has_value() || touched.points == 0),
                 fmt::format("The map held {} points of {} at the end.", touched.points, name)});
  return all;
}

Evidence of_place(const FlightLog& log, const std::optional<ObstacleStory>& touched) {
  const double error_m = position_error_m(log.moments.back()).norm();
  const double off_m = touched && touched->points > 0 ? touched->points_off_world.head<2>().norm() : 0;
  // off_m counts from the axis, and a camera sees the skin.
  const double skin_m = touched ? log.obstacles[touched->obstacle].radius_m : 0;
  std::string sentence = fmt::format("The estimate was {:.2f} m off at the end", error_m);
  if (off_m > 0) sentence += fmt::format(", the points of what it touched {:.2f} m", off_m);
  return {"wrong place", "state", off_m > std::max(wrong_m, skin_m + beside_m) || error_m > 2 * wrong_m,
          sentence + "."};
}

Evidence of_lateness(const FlightLog& log) {
  double sum_s = 0;
  std::size_t frames = 0;
  for (const LogFrame& frame : log.frames) {
    if (frame.t_ns < end_ns(log) - lately_ns) continue;
    sum_s += seconds(frame.arrival_ns - frame.t_ns);
    ++frames;
  }
  const double mean_s = frames > 0 ? sum_s / static_cast<double>(frames) : 0;
  return {"too late", "latency", mean_s > late_s,
          fmt::format("Frames were {:.0f} ms old when the autopilot had them.", 1e3 * mean_s)};
}

Evidence of_search(const FlightLog& log, double last_chance_s) {
  const std::int64_t last_ns = end_ns(log) - nanoseconds(last_chance_s);
  std::size_t fallbacks = 0, plans = 0;
  for (const LogPlan& plan : log.plans) {
    if (plan.t_ns < last_ns - lately_ns || plan.t_ns > last_ns) continue;
    ++plans;
    fallbacks += plan.origin == PlanOrigin::fallback;
  }
  return {"not found", "search", fallbacks > 0,
          fmt::format("Of the {} plans of the {:.1f} s until {:.2f} s before its end {} were emergency "
                      "manoeuvres, since no free way was found.",
                      plans, 1e-9 * lately_ns, last_chance_s, fallbacks)};
}

/// How far the aircraft came to be from where its plans, a moment before, expected it.
Evidence of_tracking(const FlightLog& log) {
  const double step_s = log.scenario.autopilot.planner.trajectory.step_s;
  const auto ahead = static_cast<std::size_t>(std::lround(planned_s / step_s));
  double square = 0;
  std::size_t count = 0;
  for (const LogPlan& plan : log.plans) {
    // A plan starts where the aircraft will be when the elevons first move by it.
    const std::int64_t then_ns = plan.t_ns + nanoseconds(log.scenario.airframe.input_delay_s + planned_s);
    if (plan.t_ns < end_ns(log) - lately_ns || then_ns > end_ns(log) || plan.way_odometry.size() <= ahead)
      continue;
    square +=
        (moment_at(log, then_ns).T_odometry_body.translation() - plan.way_odometry[ahead]).squaredNorm();
    ++count;
  }
  const double rms_m = count > 0 ? std::sqrt(square / static_cast<double>(count)) : 0;
  return {
      "not flown", "tracking", rms_m > unplanned_m,
      fmt::format("It came to be {:.2f} m (root mean square) from where its plans expected it {} s before.",
                  rms_m, planned_s)};
}

/// A cause as the beginning of a sentence.
std::string_view lead(std::string_view cause) {
  constexpr std::pair<std::string_view, std::string_view> leads[] = {
      {"never in view", "What it hit was never in view where the detector looks"},
      {"seen too late", "It saw what it hit too late"},
      {"not detected", "What it hit was in view and not detected"},
      {"false obstacle", "It took things for obstacles that are not there"},
      {"forgotten", "It forgot what it had seen"},
      {"sensor's fault", "A sensor failed, and the estimate went wrong with it"},
      {"wrong place", "It believed itself or its obstacles elsewhere than they were"},
      {"too late", "What it saw reached the autopilot too late"},
      {"not found", "There was a way, and the planner did not find it"},
      {"not flown", "There was a plan, and the aircraft did not fly it"}};
  for (const auto& [known, words] : leads)
    if (known == cause) return words;
  return cause;
}

}  // namespace

std::vector<Evidence> evidence_in(const FlightLog& log, double last_chance_s) {
  const FlightStory story = story_of(log);
  std::vector<Evidence> all;
  if (story.touched) all = of_obstacle(*story.touched, log);
  all.push_back(of_false_points(log));
  const std::string failed = failed_sensors(log);
  if (!failed.empty())  // else an estimate that the log does not show to be wrong would be a sensor's fault
    all.push_back({"sensor's fault", "state", true, fmt::format("A sensor failed: {}.", failed)});
  all.push_back(of_place(log, story.touched));
  all.push_back(of_lateness(log));
  all.push_back(of_search(log, last_chance_s));
  all.push_back(of_tracking(log));
  return all;
}

Conclusion conclusion_of(const Explanation& explanation, const std::vector<Evidence>& evidence) {
  const std::string last_chance =
      explanation.last_chance_s
          ? fmt::format("The flight still had a chance {:.2f} s before its end", *explanation.last_chance_s)
          : "At no moment that was tried had the flight a chance of one in five";
  std::string of_everything;
  for (const Chance& one : explanation.chances)  // the last entry is of the earliest moment
    if (one.part == all_ideal)
      of_everything = fmt::format(
          "of {} flights that went on with everything ideal from {} s before its end, {} survived.",
          one.flown.of, one.before_end_s, one.flown.with);
  if (explanation.cause == "infeasible")
    return {"infeasible", "An aircraft that knows everything is mostly lost, too: " + of_everything};
  if (explanation.cause == "chance")
    return {"chance",
            last_chance + ", and no part has an effect that is told from zero: " +
                (explanation.last_chance_s ? "with other noise it might have arrived." : of_everything)};
  if (explanation.cause == "joint") {
    const std::string_view needed = explanation.parts.empty() ? "" : ", though not without an ideal ";
    return {"joint", fmt::format("{}; no single part would have helped, but all of them together{}{}.",
                                 last_chance, needed, fmt::join(explanation.parts, " or "))};
  }
  const Effect& effect = *std::ranges::find(explanation.effects, explanation.cause, &Effect::part);
  Conclusion conclusion;
  // Sight saves also whoever missed a thing while it stood where the detector looks: an ideal detection that
  // comes later does not find it.
  const auto of_part = [&](const Evidence& one) {
    return one.part == explanation.cause || (explanation.cause == "sight" && one.cause == "not detected");
  };
  auto shown =
      std::ranges::find_if(evidence, [&](const Evidence& one) { return of_part(one) && one.is_there; });
  const bool is_shown = shown != evidence.end();
  if (!is_shown) shown = std::ranges::find_if(evidence, of_part);
  conclusion.cause = shown != evidence.end() ? shown->cause : explanation.cause;
  const std::string beginning = is_shown ? std::string(lead(conclusion.cause))
                                         : fmt::format("An ideal {} would have saved it", explanation.cause);
  conclusion.sentence = fmt::format(
      "{}: of {} pairs of flights that went on from {} s before its end, {} survived with an ideal {}, and "
      "{} without. {}",
      beginning, effect.pairs.pairs(), fmt::join(explanation.decisive_s, " or "), effect.pairs.second(),
      explanation.cause, effect.pairs.first(), shown != evidence.end() ? shown->sentence : "");
  if (!is_shown) {
    conclusion.disagreement = "The log itself does not show it: ";
    conclusion.disagreement +=
        shown != evidence.end() ? "what it shows of " + explanation.cause + " is within bounds."
                                : "it touched nothing, and " + explanation.cause + " leaves no other trace.";
  }
  return conclusion;
}

}  // namespace understory
