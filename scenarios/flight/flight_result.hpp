#pragma once

#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "planning/plan.hpp"

namespace understory {

/// A running 64-bit hash of everything a flight produced, bit for bit. Equal scenario, seed and binary give
/// equal digests on one machine. Eight bytes at a time are folded in by splitmix64's mixer (Steele, Lea &
/// Flood 2014): not cryptographic, but every bit of every word reaches every bit of the result. Images go
/// into eight chains side by side, the words in turn, which are then folded in themselves.
class RunDigest {
 public:
  void add(std::uint64_t word);
  void add(double value);
  void add(const Eigen::Isometry3d& pose);
  void add(std::span<const std::byte> bytes);
  std::string hex() const;

 private:
  std::uint64_t state_ = 0x6a09e667f3bcc908u;
};

/// How a flight ended.
enum class Outcome {
  goal,           ///< passed the goal plane
  collision,      ///< touched an obstacle (MuJoCo's own contact), or leaves if these end the flight
  ground,         ///< touched the ground
  out_of_bounds,  ///< left the altitude band after climbing into it, or the course's sides
  time            ///< ran out of simulated time
};

inline constexpr std::array<std::string_view, 5> outcome_names{"goal", "collision", "ground", "out_of_bounds",
                                                               "time"};
constexpr std::string_view word_for(Outcome outcome) {
  return outcome_names[static_cast<std::size_t>(outcome)];
}
/// Empty if no outcome has this name.
std::optional<Outcome> outcome_named(std::string_view word);

/// Wall time of one stage of the loop, for people. It decides nothing.
struct StageTiming {
  std::string stage;
  std::int64_t count = 0;
  double total_s = 0;
  double maximum_s = 0;
};

/// What a result and a campaign's row say of a flight that was flown.
struct FlightMeasures {
  double distance_m = 0;
  double progress_m = 0;
  double among_obstacles_m = 0;
  double mean_speed_mps = 0;
  double minimum_clearance_m = std::numeric_limits<double>::infinity();
  double leaves_s = 0;
  double leaves_m = 0;
  double position_error_mean_m = 0;
  double position_error_max_m = 0;
  std::int64_t detections = 0;
  std::int64_t remembered_points = 0;
  std::int64_t minimum_points_on_an_obstacle = -1;
  // Of a lost flight.
  std::string left_through, touched, touched_by, last_plan;
  double last_plan_clearance_m = std::numeric_limits<double>::quiet_NaN();
  double in_view_m = last_plan_clearance_m, in_view_s = last_plan_clearance_m;
  double detected_m = last_plan_clearance_m, detected_s = last_plan_clearance_m;
  std::int64_t points_of_touched = -1;
  double points_off_m = last_plan_clearance_m;
  PlannerCounts planner;
  double simulated_s = 0;
  std::string digest;
};

template <typename Visitor, typename Measures>
requires std::same_as<std::remove_const_t<Measures>, FlightMeasures>
void visit_fields(Visitor& visit, Measures& measures) {
  visit("distance_m", measures.distance_m, "true length of the flown path since release");
  visit("progress_m", measures.progress_m, "largest true x coordinate reached");
  visit("among_obstacles_m", measures.among_obstacles_m,
        "progress_m beyond the first obstacle: what counts as flown between crashes");
  visit("mean_speed_mps", measures.mean_speed_mps, "mean true speed over ground since release");
  visit("minimum_clearance_m", measures.minimum_clearance_m,
        "Smallest true distance between aircraft and obstacles. Without obstacles it is infinite: empty in "
        "CSV, null in JSON.");
  visit("leaves_s", measures.leaves_s, "time in which the wing overlapped leaves of the woods");
  visit("leaves_m", measures.leaves_m, "length of the path on which the wing overlapped leaves of the woods");
  visit("position_error_mean_m", measures.position_error_mean_m,
        "mean distance between estimated and true position since release");
  visit("position_error_max_m", measures.position_error_max_m,
        "largest distance between estimated and true position since release");
  visit("detections", measures.detections, "number of detections in all frames");
  visit("remembered_points", measures.remembered_points,
        "number of points added to the map during the flight");
  visit("minimum_points_on_an_obstacle", measures.minimum_points_on_an_obstacle,
        "Number of points added to the map within 0.5 m of the obstacle that has the fewest. Empty in CSV "
        "and null in JSON on a course with no obstacle or more than eight.");
  visit("left_through", measures.left_through,
        "bound through which a lost flight left the course: upper, lower, left, right or back; else empty");
  visit("touched", measures.touched,
        "name of the obstacle nearest to the aircraft at a collision; empty without a collision");
  visit("touched_by", measures.touched_by, "part of the aircraft that touched it, or the ground");
  visit("in_view_m", measures.in_view_m,
        "distance to the touched obstacle when the left camera first saw 25 pixels of it");
  visit("in_view_s", measures.in_view_s, "time before the end at which that was");
  visit("detected_m", measures.detected_m, "distance to the touched obstacle at the first detection on it");
  visit("detected_s", measures.detected_s, "time before the end at which that was");
  visit("points_of_touched", measures.points_of_touched,
        "points in the map for the touched obstacle at the end; empty without a collision");
  visit("points_off_m", measures.points_off_m,
        "horizontal distance from the touched obstacle to the middle of its points in the map");
  visit("last_plan", measures.last_plan,
        "how the plan in force at the end of a lost flight came about: straight, solved, kept or fallback");
  visit("last_plan_clearance_m", measures.last_plan_clearance_m,
        "clearance that this plan expected; empty if it was comfortable");
  visit_fields(visit, measures.planner);
  visit("simulated_s", measures.simulated_s,
        "simulated time from the start at rest to the end of the flight");
  visit("digest", measures.digest,
        "hash of the flight's data; flights that agree bit for bit have equal digests");
}

/// One flight in numbers: what result.json holds.
struct FlightResult : FlightMeasures {
  Outcome outcome = Outcome::time;
  std::string scenario;
  std::uint64_t seed = 0;
  std::uint64_t sensor_seed = 0;
  std::string detector;
  std::string state_source;
  double position_error_end_m = 0;
  double attitude_error_max_rad = 0;
  double velocity_error_mean_mps = 0;
  std::int64_t frames = 0;
  double wall_s = 0;
  std::string renderer;
  std::string contradiction;
  /// Number of points added to the map within 0.5 m of each obstacle, by its name; only on courses of at most
  /// eight obstacles.
  std::vector<std::pair<std::string, std::int64_t>> points_on_obstacles;
  /// wall time of each stage of the simulation: count, mean, maximum and total
  std::vector<StageTiming> timings;
};

/// All but the lists.
template <typename Visitor, typename Result>
requires std::same_as<std::remove_const_t<Result>, FlightResult>
void visit_fields(Visitor& visit, Result& result) {
  using Measures = std::conditional_t<std::is_const_v<Result>, const FlightMeasures, FlightMeasures>;
  visit("outcome", result.outcome,
        "how the flight ended: goal, collision, ground (touched), out_of_bounds (sides or altitude limits) "
        "or time (limit reached)");
  visit("scenario", result.scenario, "name of the scenario");
  visit("seed", result.seed, "the scenario's seed, for course and wind");
  visit("sensor_seed", result.sensor_seed, "seed of the sensors' noise");
  visit("detector", result.detector, "value of perception.detector");
  visit("state_source", result.state_source, "value of estimation.source");
  visit_fields(visit, static_cast<Measures&>(result));
  visit("position_error_end_m", result.position_error_end_m,
        "distance between estimated and true position at the end of the flight");
  visit("attitude_error_max_rad", result.attitude_error_max_rad,
        "largest angle between estimated and true attitude since release");
  visit("velocity_error_mean_mps", result.velocity_error_mean_mps,
        "mean magnitude of the velocity error since release");
  visit("frames", result.frames, "number of stereo frames that the autopilot processed");
  visit("wall_s", result.wall_s, "wall time that the program took to simulate the flight");
  visit("renderer", result.renderer,
        "name of the OpenGL renderer that drew the images; empty without images");
  visit(
      "contradiction", result.contradiction,
      "what in the result cannot be true, for example a clearance below zero without a contact; else empty");
}

/// The columns of trajectory.csv, a line.
extern const char* const trajectory_columns;

/// As indented JSON text, versions of program and libraries included.
std::string to_json(const FlightResult& result);

/// Reads it back, except the timings. Throws ScenarioError, naming `name`, if the text is not a result.
FlightResult result_from_json(const std::string& text, const std::string& name);

/// What a person reads of a result, line by line: a heading and words.
std::vector<std::pair<std::string, std::string>> result_lines(const FlightResult& result);
/// The same as one screen.
std::string to_report(const FlightResult& result);

}  // namespace understory
