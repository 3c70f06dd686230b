#include <cmath>
#include <utility>

#include "planning/manoeuvre.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/planners.hpp"

namespace understory {
namespace {

constexpr double greatest_clearance_m = 3;  ///< beyond which clearances are equal

/// Straight on, then turns, the gentlest first, then climbs and descents.
std::vector<Manoeuvre> library_of(const ManoeuvreSearchConfig& limits) {
  std::vector<Manoeuvre> library = avoidance_primitives(limits.maximum_bank_rad);
  for (const double duration_s : {0.4, 0.8}) {
    library.push_back({{{0, limits.maximum_climb_mps}, duration_s}});
    library.push_back({{{0, limits.minimum_climb_mps}, duration_s}});
  }
  return library;
}

class LibraryPlanner : public Planner {
 public:
  LibraryPlanner(const PlannerContext& context, const ManoeuvreLibraryConfig& library)
      : config_(context.config),
        model_(context.model),
        mission_(context.mission),
        safe_m_(library.safe_clearance_m),
        library_(library_of(context.config.search)) {}

  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    return is_near(point, plan, config_);
  }

  Plan plan(const PlanRequest& request) override {
    ++counts_.replans;
    const ObstacleField field(config_.field, request.points, request.distance_flown_m, greatest_clearance_m);
    // Rollouts ask for clearances up to the comfortable one; the library compares larger ones.
    TrajectoryConfig limits = config_.trajectory;
    limits.comfortable_clearance_m = greatest_clearance_m;
    const FlightTask task{
        model_, limits, mission_, field, request.start.position_world, &counts_.model_steps};
    const auto flown = [&](const Manoeuvre& manoeuvre, bool keep_points) {
      return fly_out(task, request.start, manoeuvre, limits.minimum_clearance_m, keep_points, false);
    };
    const auto is_safe = [&](const Rollout& rollout) {
      return rollout.reached_horizon && rollout.minimum_clearance_m >= safe_m_;
    };

    Rollout straight = flown({}, true);
    if (is_safe(straight)) {
      ++counts_.straight;
      return adopt(request.t_ns, {}, PlanOrigin::straight, std::move(straight));
    }
    ++counts_.obstacle_ahead;
    Manoeuvre left = rest_of(manoeuvre_, 1e-9 * static_cast<double>(request.t_ns - manoeuvre_t_ns_));
    if (!left.empty()) {
      if (Rollout kept = flown(left, true); is_safe(kept)) {
        ++counts_.kept;
        return adopt(request.t_ns, std::move(left), PlanOrigin::kept, std::move(kept));
      }
    }
    ++counts_.searches;
    Manoeuvre widest;
    double maximum_m = -INFINITY;
    for (const Manoeuvre& manoeuvre : library_) {  // the first of equal ones, the gentlest
      const double margin_m = flown(manoeuvre, false).minimum_margin_m;
      if (margin_m > maximum_m) maximum_m = margin_m, widest = manoeuvre;
    }
    count("manoeuvres_tried") += static_cast<std::int64_t>(library_.size());
    Rollout rollout = flown(widest, true);
    const bool safe = is_safe(rollout);
    if (safe) ++counts_.found;
    ++(safe ? counts_.solved : counts_.fallback);
    return adopt(request.t_ns, std::move(widest), safe ? PlanOrigin::solved : PlanOrigin::fallback,
                 std::move(rollout));
  }

 private:
  Plan adopt(std::int64_t t_ns, Manoeuvre manoeuvre, PlanOrigin origin, Rollout rollout) {
    manoeuvre_ = std::move(manoeuvre);
    manoeuvre_t_ns_ = t_ns;
    const bool is_near = rollout.minimum_clearance_m < config_.trajectory.comfortable_clearance_m;
    return {t_ns, origin, std::move(rollout.points), is_near ? rollout.minimum_clearance_m : INFINITY};
  }

  PlannerConfig config_;
  FlightModel model_;
  Mission mission_;
  double safe_m_;
  std::vector<Manoeuvre> library_;
  Manoeuvre manoeuvre_;  ///< in force, counted from manoeuvre_t_ns_
  std::int64_t manoeuvre_t_ns_ = 0;
};

}  // namespace

std::unique_ptr<Planner> library_planner(const PlannerContext& context,
                                         const ManoeuvreLibraryConfig& library) {
  return std::make_unique<LibraryPlanner>(context, library);
}

}  // namespace understory
