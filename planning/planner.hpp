#pragma once

#include <cstdint>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "planning/flight_model.hpp"
#include "planning/plan.hpp"

namespace understory {

/// What a plan is asked for.
struct PlanRequest {
  FlightState start;       ///< where the aircraft will be at t_ns, heights above the ground
  std::int64_t t_ns = 0;   ///< when the plan takes effect
  std::vector<ObstaclePoint> points = {};  ///< what the map trusts, world frame, heights above the ground
  double distance_flown_m = 0;             ///< at t_ns less that of a point: how far its place may have drifted
  /// Whether `points` has something near the plan in force that was not there when that was made. Where it has
  /// not, a planner may go on with its plan.
  bool outdated = true;
};

/// Decides which way the aircraft goes. Equal requests in equal order give equal plans: a planner counts
/// iterations and never time, and draws from generators of its own.
class Planner {
 public:
  virtual ~Planner() = default;
  /// A plan from the start on: its first point is the start, its points are evenly spaced in time and reach as
  /// far as the planner looks ahead. There always is one, where everything is blocked too.
  virtual Plan plan(const PlanRequest& request) = 0;

  /// What a planner counts of its work; those it leaves at zero are of no consequence.
  const PlannerCounts& counts() const { return counts_; }

 protected:
  PlannerCounts counts_;
};

}  // namespace understory
