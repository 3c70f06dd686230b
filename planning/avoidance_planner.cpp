#include "planning/avoidance_planner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace understory {
namespace {

/// The manoeuvre flown to the horizon with all its points, through obstacles too.
Rollout flown_through(const FlightTask& task, const FlightState& start, const Manoeuvre& manoeuvre) {
  return fly_out(task, start, manoeuvre, task.config.minimum_clearance_m, true, false);
}

}  // namespace

AvoidancePlanner::AvoidancePlanner(const PlannerContext& context, TreeMaker tree)
    : config_(context.config),
      model_(context.model),
      mission_(context.mission),
      seed_(context.seed),
      tree_(tree),
      primitives_(avoidance_primitives(config_.search.maximum_bank_rad)) {}

Plan AvoidancePlanner::plan(const PlanRequest& request) {
  const auto& [start, t_ns, points, distance_flown_m, outdated] = request;
  ++counts_.replans;
  const double asked_m = maximum_clearance_m(
      config_.trajectory,
      std::max(config_.trajectory.minimum_clearance_m, config_.trajectory.minimum_kept_clearance_m));
  const ObstacleField field(config_.field, points, distance_flown_m, asked_m);
  const FlightTask task{model_, config_.trajectory,   mission_,
                        field,  start.position_world, &counts_.model_steps};
  const TrajectoryConfig& limits = config_.trajectory;

  Rollout straight = fly_out(task, start, {}, limits.minimum_clearance_m, true);
  if (straight.reached_horizon && straight.minimum_clearance_m >= limits.comfortable_clearance_m) {
    ++counts_.straight;
    return adopt(t_ns, {}, PlanOrigin::straight, std::move(straight));
  }

  const std::int64_t flown_on_ompl = counts_.solved + counts_.kept_ompl;
  const Plan plan = avoid(task, start, t_ns, outdated);
  if (!straight.reached_horizon) {
    ++counts_.obstacle_ahead;
    counts_.obstacle_ahead_ompl += counts_.solved + counts_.kept_ompl - flown_on_ompl;
  }
  return plan;
}

Plan AvoidancePlanner::avoid(const FlightTask& task, const FlightState& start, std::int64_t t_ns,
                             bool outdated) {
  const Manoeuvre remaining = rest_of(manoeuvre_, 1e-9 * static_cast<double>(t_ns - manoeuvre_t_ns_));
  const TrajectoryConfig& limits = config_.trajectory;
  Rollout kept = fly_out(task, start, remaining, limits.minimum_kept_clearance_m, true);
  const bool may_keep = kept.reached_horizon && manoeuvre_origin_ != PlanOrigin::fallback;
  const bool kept_good = !remaining.empty() && kept.cost <= config_.kept_cost_ratio * manoeuvre_cost_ + 1.0;
  const double searched_s = 1e-9 * static_cast<double>(t_ns - searched_t_ns_);
  const bool fresh = replans_kept_ < config_.refresh_replans && searched_s < config_.refresh_s;
  if (may_keep && (kept_good || !outdated) && fresh) {
    ++replans_kept_;
    return keep(t_ns, remaining, std::move(kept));
  }
  std::optional<Plan> searched = search(task, start, t_ns, remaining, may_keep);
  return searched ? std::move(*searched) : fall_back(task, start, t_ns);
}

Plan AvoidancePlanner::keep(std::int64_t t_ns, const Manoeuvre& manoeuvre, Rollout rollout) {
  ++counts_.kept;
  if (manoeuvre_origin_ == PlanOrigin::solved && !manoeuvre.empty()) ++counts_.kept_ompl;
  return adopt(t_ns, manoeuvre, PlanOrigin::kept, std::move(rollout));
}

std::optional<Plan> AvoidancePlanner::search(const FlightTask& task, const FlightState& start,
                                             std::int64_t t_ns, const Manoeuvre& remaining, bool may_keep) {
  const std::uint64_t search_seed = seed_ * 1'000'003 + static_cast<std::uint64_t>(counts_.replans);
  ImprovedManoeuvre kept{{}, INFINITY};
  if (may_keep)
    kept = improve_manoeuvre(task, start, remaining, config_.trajectory.minimum_kept_clearance_m,
                             config_.improvement, search_seed);
  ++counts_.searches;
  const std::optional<Manoeuvre> better = search_manoeuvre(
      task, start, remaining, config_.search, kept.cost / config_.change_cost_ratio, search_seed, tree_);
  if (better) {
    ++counts_.found;
    ++counts_.solved;
    Plan plan = adopt(t_ns, *better, PlanOrigin::solved, flown_through(task, start, *better));
    replans_kept_ = config_.refresh_replans;  // the next replan improves it
    return plan;
  }
  if (!may_keep) return std::nullopt;
  ++count("search_found_no_better");
  replans_kept_ = 0;
  searched_t_ns_ = t_ns;
  manoeuvre_cost_ = kept.cost;
  return keep(t_ns, kept.manoeuvre, flown_through(task, start, kept.manoeuvre));
}

Plan AvoidancePlanner::fall_back(const FlightTask& task, const FlightState& start, std::int64_t t_ns) {
  ++counts_.fallback;
  const TrajectoryConfig& limits = config_.trajectory;
  Manoeuvre widest;
  double maximum_m = -INFINITY, minimum_cost = INFINITY;
  for (const Manoeuvre& primitive : primitives_) {
    // One that comes nearer than the widest so far is not flown to its end: it could not win.
    const Rollout rollout = fly_out(task, start, primitive, maximum_m, false);
    // Clearance beyond the comfortable one does not count: the cheaper primitive wins.
    const double clearance_m = std::min(rollout.minimum_margin_m, limits.comfortable_clearance_m);
    if (clearance_m < maximum_m || (clearance_m == maximum_m && rollout.cost >= minimum_cost)) continue;
    maximum_m = clearance_m;
    minimum_cost = rollout.cost;
    widest = primitive;
  }
  return adopt(t_ns, widest, PlanOrigin::fallback, flown_through(task, start, widest));
}

Plan AvoidancePlanner::adopt(std::int64_t t_ns, const Manoeuvre& manoeuvre, PlanOrigin origin,
                             Rollout rollout) {
  if (origin != PlanOrigin::kept) {
    manoeuvre_origin_ = origin;
    manoeuvre_cost_ = rollout.cost;
    replans_kept_ = 0;
    searched_t_ns_ = t_ns;
  }
  manoeuvre_ = manoeuvre;
  manoeuvre_t_ns_ = t_ns;
  const bool is_near = rollout.minimum_clearance_m < config_.trajectory.comfortable_clearance_m;
  return {t_ns, origin, std::move(rollout.points), is_near ? rollout.minimum_clearance_m : INFINITY};
}

}  // namespace understory
