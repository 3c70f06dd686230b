#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planning/manoeuvre.hpp"
#include "planning/manoeuvre_improvement.hpp"
#include "planning/manoeuvre_search.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/plan.hpp"
#include "planning/planner_counts.hpp"

namespace understory {

struct PlannerConfig {
  bool use_ompl = true;  ///< false: the fallback primitives alone answer when the straight way is blocked
  /// A plan in force whose cost has not grown past this share of its cost when new is kept without a search.
  double kept_cost_ratio = 1.3;
  double change_cost_ratio =
      1.5;                   ///< another way must be this much cheaper than the plan in force: no dithering
  int refresh_replans = 12;  ///< a kept plan is searched against anew after this many replans,
  double refresh_s = 1;      ///< or after this long
  ObstacleFieldConfig field;
  TrajectoryConfig trajectory;
  ManoeuvreSearchConfig search;
  ManoeuvreImprovementConfig improvement;
};

template <typename Visitor>
void visit_fields(Visitor& visit, PlannerConfig& config) {
  visit("use_ompl", config.use_ompl);
  visit("kept_cost_ratio", config.kept_cost_ratio, 1.0, 100.0);
  visit("change_cost_ratio", config.change_cost_ratio, 1.0, 100.0);
  visit("refresh_replans", config.refresh_replans, 1, 1000);
  visit("refresh_s", config.refresh_s, 0.0, 10.0);
  visit("field", config.field);
  visit("trajectory", config.trajectory);
  visit("search", config.search);
  visit("improvement", config.improvement);
}

/// Receding-horizon avoidance. The first of these that is possible is flown: straight on where that is free;
/// the plan in force while it is free and good; what OMPL finds; the primitive with the maximum clearance.
class AvoidancePlanner {
 public:
  AvoidancePlanner(const PlannerConfig& config, const FlightModel& model, const Mission& mission,
                   std::uint64_t seed);

  /// A plan from `start`, where the aircraft will be at `t_ns`, when the plan takes effect. `outdated`:
  /// `points` differ from those of the plan in force. Where they do not and that plan is free, a new search
  /// is made only when the refresh is due.
  Plan plan(const FlightState& start, std::int64_t t_ns, const std::vector<ObstaclePoint>& points,
            double distance_flown_m, bool outdated = true);

  const PlannerCounts& counts() const { return counts_; }

 private:
  /// The rest of the manoeuvre in force at `t_ns`.
  Manoeuvre remaining(std::int64_t t_ns) const;
  Plan keep(std::int64_t t_ns, const Manoeuvre& manoeuvre, Rollout rollout);
  /// OMPL's answer; or `left`, where `may_keep` and OMPL's is not clearly cheaper; or nothing.
  std::optional<Plan> search(const FlightTask& task, const FlightState& start, std::int64_t t_ns,
                             const Manoeuvre& left, bool may_keep);
  Plan fall_back(const FlightTask& task, const FlightState& start, std::int64_t t_ns);
  /// The plan where the straight way comes nearer than the comfortable clearance.
  Plan avoid(const FlightTask& task, const FlightState& start, std::int64_t t_ns, bool outdated);
  /// Puts `manoeuvre` in force; `rollout` is it, flown from the plan's start, with points.
  Plan adopt(std::int64_t t_ns, const Manoeuvre& manoeuvre, PlanOrigin origin, Rollout rollout);

  PlannerConfig config_;
  FlightModel model_;
  Mission mission_;
  std::uint64_t seed_;
  std::vector<Manoeuvre> primitives_;
  PlannerCounts counts_;
  Manoeuvre manoeuvre_;  ///< in force, counted from manoeuvre_t_ns_
  std::int64_t manoeuvre_t_ns_ = 0;
  PlanOrigin manoeuvre_origin_ = PlanOrigin::straight;
  double manoeuvre_cost_ = 0;
  int replans_kept_ = 0;
  std::int64_t searched_t_ns_ = 0;  ///< when it was last found, or found to be the best
};

/// The fallback's choices: level, turns of several banks to either side, held or reversed after a while.
std::vector<Manoeuvre> avoidance_primitives(double maximum_bank_rad);

}  // namespace understory
