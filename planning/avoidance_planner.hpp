#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planning/autopilot_config.hpp"
#include "planning/manoeuvre.hpp"
#include "planning/manoeuvre_search.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/planner.hpp"

namespace understory {

/// Receding-horizon avoidance. Flies the first of these that is possible: straight on, if that is free; the
/// plan in force, while it is free and good; the manoeuvre that the tree finds; the primitive with the
/// maximum clearance.
class AvoidancePlanner : public Planner {
 public:
  AvoidancePlanner(const PlannerContext& context, TreeMaker tree);

  /// If the request is not outdated and the plan in force is free, a new search is made only when the refresh
  /// is due.
  Plan plan(const PlanRequest& request) override;
  void change(const PlannerConfig& config, std::uint64_t seed) override {
    config_ = config;
    seed_ = seed;
  }
  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    return is_near(point, plan, config_);
  }

 private:
  Plan keep(std::int64_t t_ns, const Manoeuvre& manoeuvre, Rollout rollout);
  /// The tree's answer; or `remaining`, if `may_keep` and the answer is not clearly cheaper; or nothing.
  std::optional<Plan> search(const FlightTask& task, const FlightState& start, std::int64_t t_ns,
                             const Manoeuvre& remaining, bool may_keep);
  Plan fall_back(const FlightTask& task, const FlightState& start, std::int64_t t_ns);
  /// The plan if the straight path comes nearer than the comfortable clearance.
  Plan avoid(const FlightTask& task, const FlightState& start, std::int64_t t_ns, bool outdated);
  /// Puts `manoeuvre` in force; `rollout`: `manoeuvre` flown from the plan's start, with points.
  Plan adopt(std::int64_t t_ns, const Manoeuvre& manoeuvre, PlanOrigin origin, Rollout rollout);

  PlannerConfig config_;
  FlightModel model_;
  Mission mission_;
  std::uint64_t seed_;
  TreeMaker tree_;
  std::vector<Manoeuvre> primitives_;
  Manoeuvre manoeuvre_;  ///< in force, counted from manoeuvre_t_ns_
  std::int64_t manoeuvre_t_ns_ = 0;
  PlanOrigin manoeuvre_origin_ = PlanOrigin::straight;
  double manoeuvre_cost_ = 0;
  int replans_kept_ = 0;
  std::int64_t searched_t_ns_ = 0;  ///< when it was last found or confirmed as the best
};

}  // namespace understory
