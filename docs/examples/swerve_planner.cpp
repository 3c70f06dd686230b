// A planner of one's own: straight on, or a bank to the side with more room.
#include <cmath>
#include <utility>

#include "planning/manoeuvre.hpp"
#include "scenarios/scenario/plugin.hpp"

namespace {

using namespace understory;

struct SwerveConfig {
  double bank_rad = 0.9;
  double hold_s = 0.7;
};

template <typename Visitor>
void visit_fields(Visitor& visit, SwerveConfig& config) {
  visit("bank_rad", config.bank_rad, 0.1, 1.5, "bank of a swerve");
  visit("hold_s", config.hold_s, 0.1, 3.0,
        "time for which the bank is held before the course guidance takes over");
}

class SwervePlanner : public Planner {
 public:
  SwervePlanner(const PlannerContext& context, const SwerveConfig& config)
      : planner_(context.config), model_(context.model), mission_(context.mission), config_(config) {}

  Plan plan(const PlanRequest& request) override {
    ++counts_.replans;
    const TrajectoryConfig& limits = planner_.trajectory;
    const ObstacleField field(planner_.field, request.points, request.distance_flown_m);
    const FlightTask task{model_, limits, mission_, field, request.start.position_world};
    Plan best;
    best.t_ns = request.t_ns;
    for (const double bank_rad : {0.0, -config_.bank_rad, config_.bank_rad}) {
      const Manoeuvre manoeuvre{{{bank_rad, 0}, bank_rad == 0 ? 0 : config_.hold_s}};
      Rollout rollout = fly_out(task, request.start, manoeuvre, limits.minimum_clearance_m, true, false);
      if (!best.points.empty() && rollout.minimum_margin_m <= best.clearance_m) continue;
      best.points = std::move(rollout.points);
      best.clearance_m = rollout.minimum_margin_m;
      best.origin = bank_rad == 0 ? PlanOrigin::straight : PlanOrigin::solved;
      if (bank_rad == 0 && best.clearance_m >= limits.comfortable_clearance_m) break;
    }
    if (best.origin == PlanOrigin::solved) ++count("swerves");
    return best;
  }

 private:
  PlannerConfig planner_;
  FlightModel model_;
  Mission mission_;
  SwerveConfig config_;
};

}  // namespace

UNDERSTORY_PLUGIN(parts) {
  parts.planners.add({.name = "swerve",
                      .meaning = "straight on, or a bank to the side with more room",
                      .make =
                          [](const PlannerPartContext& context) {
                            return std::make_unique<SwervePlanner>(context,
                                                                   own_config<SwerveConfig>(context));
                          }},
                     SwerveConfig{});
}
