#include <cmath>
#include <utility>

#include "planning/manoeuvre.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/planners.hpp"

namespace understory {
namespace {

class StraightPlanner : public Planner {
 public:
  explicit StraightPlanner(const PlannerContext& context)
      : config_(context.config), model_(context.model), mission_(context.mission) {}

  bool concerns(const ObstaclePoint&, const Plan&) const override { return false; }

  Plan plan(const PlanRequest& request) override {
    ++counts_.replans;
    ++counts_.straight;
    const TrajectoryConfig& limits = config_.trajectory;
    const ObstacleField field(config_.field, request.points, request.distance_flown_m,
                              limits.comfortable_clearance_m);
    const FlightTask task{
        model_, limits, mission_, field, request.start.position_world, &counts_.model_steps};
    Rollout rollout = fly_out(task, request.start, {}, limits.minimum_clearance_m, true, false);
    if (!rollout.reached_horizon) ++counts_.obstacle_ahead;
    const bool is_free = rollout.minimum_clearance_m >= limits.comfortable_clearance_m;
    return {request.t_ns, PlanOrigin::straight, std::move(rollout.points),
            is_free ? INFINITY : rollout.minimum_clearance_m};
  }

 private:
  PlannerConfig config_;
  FlightModel model_;
  Mission mission_;
};

}  // namespace

std::unique_ptr<Planner> straight_planner(const PlannerContext& context) {
  return std::make_unique<StraightPlanner>(context);
}

}  // namespace understory
