#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "planning/autopilot_config.hpp"
#include "planning/flight_model.hpp"
#include "planning/plan.hpp"

namespace understory {

/// One request for a plan. World frame of the estimator; heights are above the ground. With GPS, horizontal
/// places are those of the world, as the newest fix has them.
struct PlanRequest {
  FlightState start;                       ///< where the aircraft will be at t_ns
  std::int64_t t_ns = 0;                   ///< when the plan takes effect
  std::vector<ObstaclePoint> points = {};  ///< obstacle points that the map trusts
  /// distance flown until now; the excess over a point's own distance_flown_m is how far it may have drifted
  double distance_flown_m = 0;
  /// Whether, since the last plan, a point has come that may change it according to concerns(). If not, a
  /// planner may keep its plan without a search.
  bool outdated = true;
};

/// Decides the path of the aircraft. Equal requests in equal order must give equal plans: a planner counts
/// iterations instead of measuring time, and owns its random generators.
class Planner {
 public:
  virtual ~Planner() = default;

  /// A plan from the start on: its t_ns is the request's, its first point is the start, its points are evenly
  /// spaced in time and reach as far as the planner looks ahead. There is always one, even if every path is
  /// blocked.
  virtual Plan plan(const PlanRequest& request) = 0;

  /// Whether `point`, which the map did not hold when `plan` was made, may change the plan. The autopilot
  /// then requests a new plan at the next opportunity, instead of at the end of the period.
  virtual bool concerns(const ObstaclePoint& /*point*/, const Plan& /*plan*/) const { return true; }

  /// From now on other settings and other random numbers; the plan in force stays. A planner that does not
  /// know how goes on as before.
  virtual void change(const PlannerConfig& /*config*/, std::uint64_t /*seed*/) {}

  /// How the plans came about. A planner counts what applies to it; all other counts stay zero.
  const PlannerCounts& counts() const { return counts_; }

 protected:
  /// A count of the planner's own, from zero on. A name is a word like a key's name.
  std::int64_t& count(std::string_view name) {
    for (auto& [known, number] : counts_.own)
      if (known == name) return number;
    return counts_.own.emplace_back(name, 0).second;
  }

  PlannerCounts counts_;
};

/// What a planner is made from. All of it may be gone after the planner has been made.
struct PlannerContext {
  const PlannerConfig& config;
  const FlightModel& model;
  const Mission& mission;
  std::uint64_t seed = 0;  ///< of the planner's random generators
};

}  // namespace understory
