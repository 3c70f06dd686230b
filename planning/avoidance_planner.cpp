#include "planning/avoidance_planner.hpp"

#include <cmath>
#include <optional>

namespace understory {

AvoidancePlanner::AvoidancePlanner(const PlannerConfig& config, const FlightModel& model,
                                   const Mission& mission, std::uint64_t seed)
    : config_(config), model_(model), mission_(mission), seed_(seed) {}

Plan AvoidancePlanner::plan(const FlightState& start, std::int64_t t_ns,
                            const std::vector<ObstaclePoint>& points, double distance_flown_m) {
  ++replan_index_;
  const ObstacleField field(config_.field, points, distance_flown_m);
  const FlightTask task{model_, config_.trajectory, mission_, field, start.position_world};
  const TrajectoryConfig& limits = config_.trajectory;

  const Rollout straight = fly_out(task, start, {}, limits.least_clearance_m, false);
  if (straight.reached_horizon && straight.least_clearance_m >= limits.comfortable_clearance_m) {
    ++counts_.straight;
    return adopt(task, start, t_ns, {}, PlanOrigin::straight);
  }

  // Candidates that need no search: straight on with less than comfort, and what is left of the plan in
  // force.
  const Manoeuvre left = remaining(t_ns);
  const Rollout kept = fly_out(task, start, left, limits.least_kept_clearance_m, false);
  const bool kept_good = kept.reached_horizon && manoeuvre_origin_ != PlanOrigin::fallback &&
                         kept.cost <= config_.kept_cost_ratio * manoeuvre_cost_ + 1.0;
  if (kept_good && !left.empty() && replans_kept_ < config_.refresh_replans) {
    ++counts_.kept;
    ++replans_kept_;
    return adopt(task, start, t_ns, left, PlanOrigin::kept);
  }

  if (config_.use_ompl) {
    const std::uint64_t search_seed = seed_ * 1'000'003 + replan_index_;
    const auto improved = [&](const Manoeuvre& manoeuvre, double least_clearance_m) {
      return improve_manoeuvre(task, start, manoeuvre, least_clearance_m, config_.improvement, search_seed);
    };
    const bool may_keep = kept.reached_horizon && manoeuvre_origin_ != PlanOrigin::fallback;
    std::optional<Manoeuvre> found = search_manoeuvre(task, start, left, config_.search, search_seed);
    ++counts_.searched;
    if (found) ++counts_.found;
    if (found) found = improved(*found, limits.least_clearance_m);
    const Manoeuvre kept_improved = may_keep ? improved(left, limits.least_kept_clearance_m) : left;
    const double found_cost =
        found ? fly_out(task, start, *found, limits.least_clearance_m, false).cost : INFINITY;
    const double kept_cost =
        may_keep ? fly_out(task, start, kept_improved, limits.least_kept_clearance_m, false).cost : INFINITY;
    if (may_keep && kept_cost <= config_.change_cost_ratio * found_cost) {
      ++counts_.kept;
      replans_kept_ = 0;
      return adopt(task, start, t_ns, kept_improved, PlanOrigin::kept);
    }
    if (found) {
      ++counts_.solved;
      return adopt(task, start, t_ns, *found, PlanOrigin::solved);
    }
  }

  ++counts_.fallback;
  Manoeuvre widest;
  double greatest_m = -INFINITY, least_cost = INFINITY;
  for (const Manoeuvre& primitive : avoidance_primitives(config_.search.greatest_bank_rad)) {
    const Rollout rollout = fly_out(task, start, primitive, limits.least_clearance_m, false, false);
    // Beyond comfort more clearance buys nothing: the cheaper one wins.
    const double clearance_m = std::min(rollout.least_margin_m, limits.comfortable_clearance_m);
    if (clearance_m < greatest_m || (clearance_m == greatest_m && rollout.cost >= least_cost)) continue;
    greatest_m = clearance_m;
    least_cost = rollout.cost;
    widest = primitive;
  }
  return adopt(task, start, t_ns, widest, PlanOrigin::fallback);
}

Manoeuvre AvoidancePlanner::remaining(std::int64_t t_ns) const {
  double elapsed_s = 1e-9 * static_cast<double>(t_ns - manoeuvre_t_ns_);
  Manoeuvre left;
  for (ManoeuvrePart part : manoeuvre_) {
    const double used_s = std::min(elapsed_s, part.duration_s);
    elapsed_s -= used_s;
    part.duration_s -= used_s;
    if (part.duration_s > 1e-3) left.push_back(part);
  }
  return left;
}

Plan AvoidancePlanner::adopt(const FlightTask& task, const FlightState& start, std::int64_t t_ns,
                             const Manoeuvre& manoeuvre, PlanOrigin origin) {
  Rollout rollout = fly_out(task, start, manoeuvre, config_.trajectory.least_clearance_m, true, false);
  if (origin != PlanOrigin::kept) {
    manoeuvre_origin_ = origin;
    manoeuvre_cost_ = rollout.cost;
    replans_kept_ = 0;
  }
  manoeuvre_ = manoeuvre;
  manoeuvre_t_ns_ = t_ns;
  return {t_ns, origin, std::move(rollout.points)};
}

std::vector<Manoeuvre> avoidance_primitives(double greatest_bank_rad) {
  std::vector<Manoeuvre> primitives{{}};
  for (const double share : {0.2, 0.4, 0.6, 0.8, 1.0})
    for (const double side : {-1.0, 1.0})
      for (const double first_s : {0.3, 0.6, 1.0}) {
        const double bank = side * share * greatest_bank_rad;
        primitives.push_back({{{bank, 0.5}, first_s}});
        primitives.push_back({{{bank, 0.5}, first_s}, {{-bank, 0.5}, 0.7 * first_s}});
      }
  return primitives;
}

}  // namespace understory
