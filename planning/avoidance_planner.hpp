#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planning/manoeuvre.hpp"
#include "planning/manoeuvre_improvement.hpp"
#include "planning/manoeuvre_search.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/plan.hpp"

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

/// How the replans of a flight were answered. straight + solved + kept + fallback are all of them.
struct PlannerCounts {
  int straight = 0;   ///< nothing within comfort of the straight way
  int solved = 0;     ///< OMPL's answer of this replan taken
  int kept = 0;       ///< the plan in force still good
  int kept_ompl = 0;  ///< of `kept`: what is left of an OMPL answer; the others go straight with less comfort
  int fallback = 0;   ///< no free manoeuvre found: the primitive of greatest clearance
  int blocked = 0;    ///< an obstacle ahead: straight on would come nearer than the minimum clearance
  int blocked_ompl = 0;  ///< of `blocked`: flown on an OMPL answer, of this replan or kept
  int searched = 0;      ///< how often OMPL was asked (a kept plan is searched against anew now and then)
  int found = 0;         ///< how often it answered with a free manoeuvre
};

/// Receding-horizon avoidance: straight on where that is free, else the plan in force while it is free and
/// good, else what OMPL finds, else the primitive of greatest clearance.
class AvoidancePlanner {
 public:
  AvoidancePlanner(const PlannerConfig& config, const FlightModel& model, const Mission& mission,
                   std::uint64_t seed);

  /// A plan from `start`, where the aircraft will be at `t_ns` (not now: when the plan takes effect).
  /// `outdated`: the points are not those of the plan in force. Where they are, and it is free, it is
  /// searched against only when the refresh is due.
  Plan plan(const FlightState& start, std::int64_t t_ns, const std::vector<ObstaclePoint>& points,
            double distance_flown_m, bool outdated = true);

  const PlannerCounts& counts() const { return counts_; }

 private:
  /// What is left of the manoeuvre in force at `t_ns`.
  Manoeuvre remaining(std::int64_t t_ns) const;
  Plan keep(std::int64_t t_ns, const Manoeuvre& manoeuvre, Rollout rollout);
  /// OMPL's answer, or `left` where that `may_keep` and OMPL's is not clearly cheaper; nothing where neither
  /// is.
  std::optional<Plan> search(const FlightTask& task, const FlightState& start, std::int64_t t_ns,
                             const Manoeuvre& left, bool may_keep);
  Plan fall_back(const FlightTask& task, const FlightState& start, std::int64_t t_ns);
  /// The plan where the straight way is not comfortable.
  Plan avoid(const FlightTask& task, const FlightState& start, std::int64_t t_ns, bool outdated);
  /// Puts it in force; `rollout` is the manoeuvre flown from the plan's start, with its points.
  Plan adopt(std::int64_t t_ns, const Manoeuvre& manoeuvre, PlanOrigin origin, Rollout rollout);

  PlannerConfig config_;
  FlightModel model_;
  Mission mission_;
  std::uint64_t seed_;
  std::vector<Manoeuvre> primitives_;
  PlannerCounts counts_;
  std::uint64_t replan_index_ = 0;
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
