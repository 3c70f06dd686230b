#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace understory {

/// The mission: fly along `heading_rad` until past the goal plane, inside the band and the sides. Known
/// before the flight, so it may be told to the stack. World frame of the estimator, origin at the launch.
struct Mission {
  double heading_rad = 0;           ///< from world x towards world y
  double goal_distance_m = 75;      ///< of the goal plane, along the heading
  double half_width_m = 25;         ///< to each side
  double minimum_altitude_m = 1.0;  ///< in force once climbed
  double maximum_altitude_m = 6.0;
  double cruise_altitude_m = 4.5;
};

/// One moment of a plan, as the reduced flight model predicts it.
struct PlanPoint {
  double t_s = 0;  ///< since the plan's start
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  double speed_mps = 0;
  double heading_rad = 0;      ///< of the velocity through the air, from world x towards world y
  double climb_angle_rad = 0;  ///< of the same, above the horizon
  double bank_rad =
      0;  ///< right wing down positive, so that a positive bank turns to the right (heading falls)
  double angle_of_attack_rad = 0;
  double bank_command_rad = 0;  ///< the control in force
  double climb_command_mps = 0;
};

/// How a plan came about.
enum class PlanOrigin {
  straight,  ///< nothing in the way: towards the goal, holding altitude
  solved,    ///< the planner's search found it in this replan
  kept,      ///< an earlier plan, still valid and good
  fallback   ///< nothing free of collision found: the primitive with the maximum clearance
};

constexpr std::string_view word_for(PlanOrigin origin) {
  constexpr std::string_view words[] = {"straight", "solved", "kept", "fallback"};
  return words[static_cast<std::size_t>(origin)];
}

struct Plan {
  std::int64_t t_ns = 0;  ///< the time of its first point
  PlanOrigin origin = PlanOrigin::straight;
  std::vector<PlanPoint> points;  ///< evenly spaced in time; empty before the first replan
  /// Minimum free distance from the wing to the obstacles that the planner knew of, negative if the plan
  /// leads through one; +infinity if it is at least the comfortable clearance.
  double clearance_m = std::numeric_limits<double>::infinity();
};

/// How the replans of a flight were answered. straight + solved + kept + fallback is their number. `own` has
/// the counts of one planner alone, by name; result.json has them.
struct PlannerCounts {
  std::vector<std::pair<std::string, std::int64_t>> own;
  std::int64_t replans = 0;
  std::int64_t straight = 0;
  std::int64_t solved = 0;
  std::int64_t kept = 0;
  std::int64_t kept_ompl = 0;
  std::int64_t fallback = 0;
  std::int64_t obstacle_ahead = 0;
  std::int64_t obstacle_ahead_ompl = 0;
  std::int64_t searches = 0;
  std::int64_t found = 0;
  std::int64_t model_steps = 0;
  std::int64_t map_points = 0;  ///< counted by the autopilot, as the next
  std::int64_t late_plans = 0;
};

/// Every count by name, for results, rows and sums: visit(name, count).
template <typename Visitor, typename Counts>
requires std::same_as<std::remove_const_t<Counts>, PlannerCounts>
void visit_fields(Visitor& visit, Counts& counts) {
  visit("replans", counts.replans, "number of plans made");
  visit("straight", counts.straight,
        "number of plans that fly straight on, because no obstacle comes within comfortable clearance");
  visit("solved", counts.solved,
        "number of plans that use a manoeuvre that the planner's search found in the same replan");
  visit("kept", counts.kept, "number of plans that continue the plan in force, because it is still good");
  visit("kept_ompl", counts.kept_ompl,
        "number of plans counted in kept that continue a manoeuvre; the other kept plans fly straight on");
  visit("fallback", counts.fallback,
        "number of plans that use the predefined manoeuvre with the largest clearance, because no free "
        "manoeuvre was found");
  visit("obstacle_ahead", counts.obstacle_ahead,
        "number of plans made where straight flight would violate the minimum clearance to obstacles or "
        "altitude limits");
  visit("obstacle_ahead_ompl", counts.obstacle_ahead_ompl,
        "number of plans counted in obstacle_ahead that use a manoeuvre that the planner's search found, in "
        "this replan or an earlier one");
  visit("searches", counts.searches,
        "number of searches, including those that compare a kept plan with a new one");
  visit("found", counts.found, "number of searches that found a free manoeuvre better than the one in force");
  visit("model_steps", counts.model_steps,
        "number of steps of the flight model that all plans took: the planner's work");
  visit("map_points", counts.map_points,
        "number of points of the map that all plans were given, summed: the other part of their work");
  visit(
      "late_plans", counts.late_plans,
      "number of plans that were ready later than autopilot.plan_latency_s, with perception.compute.enabled");
}

}  // namespace understory
