#include "planning/avoidance_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "planning/planners.hpp"
#include "tests/planning/forests.hpp"

namespace understory {
namespace {

constexpr std::int64_t replan_ns = 40'000'000;
const Mission mission;
const PlannerConfig defaults;
const FlightModel model({}, {});

FlightState level_start() {
  FlightState start;
  start.position_world.z() = mission.cruise_altitude_m;
  return start;
}

/// Where the model says the aircraft is after following `plan` for a while.
FlightState follow_plan(FlightState state, const Plan& plan, std::int64_t duration_ns) {
  const double step_s = plan.points[1].t_s - plan.points[0].t_s;
  const auto steps = static_cast<std::size_t>(std::llround(1e-9 * static_cast<double>(duration_ns) / step_s));
  for (std::size_t i = 0; i < std::min(steps, plan.points.size()); ++i)
    state = model.advance(state, {plan.points[i].bank_command_rad, plan.points[i].climb_command_mps}, step_s);
  return state;
}

std::int64_t total(const PlannerCounts& counts) {
  return counts.straight + counts.solved + counts.kept + counts.fallback;
}

TEST(AvoidancePlanner, FliesStraightWhereNothingIsInTheWay) {
  AvoidancePlanner planner({defaults, model, mission, 1}, sst_tree);
  const Plan plan = planner.plan({level_start(), 5'000'000});
  EXPECT_EQ(plan.origin, PlanOrigin::straight);
  EXPECT_EQ(plan.t_ns, 5'000'000);
  EXPECT_EQ(planner.counts().straight, 1);
  EXPECT_EQ(total(planner.counts()), 1);
  for (const PlanPoint& point : plan.points) EXPECT_NEAR(point.position_world.y(), 0, 1e-9);
}

// The aircraft of this test is the reduced model itself, so that a touch would be the planner's own fault.
TEST(AvoidancePlanner, PlansNeverTouchAKnownTrunk) {
  const PlannerConfig config;
  const double around_m = config.field.wing_radius_m + config.field.sigma_zero_m + 0.5 * config.field.cell_m;
  const double limit_m =
      around_m + std::min(config.trajectory.minimum_clearance_m, config.trajectory.minimum_kept_clearance_m);
  PlannerCounts sum;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 generator(seed);
    const std::vector<Trunk> trunks = random_forest(generator, 16, 7, 30);
    const std::vector<ObstaclePoint> points = points_of(trunks);
    AvoidancePlanner planner({config, model, mission, seed}, sst_tree);
    FlightState state = level_start();
    for (int replan = 0; replan < 40; ++replan) {
      const Plan plan = planner.plan({state, replan * replan_ns, points});
      ASSERT_GE(plan.points.size(), 2u);
      if (plan.origin == PlanOrigin::fallback) break;  // a fallback is not free of collision
      EXPECT_GE(plan_distance_m(plan, trunks, config.field), limit_m - 1e-9)
          << "seed " << seed << " at " << replan;
      state = follow_plan(state, plan, replan_ns);
    }
    sum.straight += planner.counts().straight, sum.solved += planner.counts().solved;
    sum.kept += planner.counts().kept, sum.fallback += planner.counts().fallback;
    EXPECT_EQ(total(planner.counts()), planner.counts().replans);
  }
  EXPECT_GT(sum.solved, 10);  // the forests required dodges
  EXPECT_GT(sum.kept, 10);
  EXPECT_LE(sum.fallback, 3);
}

TEST(AvoidancePlanner, BoxedInItFallsBackAndSaysSo) {
  AvoidancePlanner planner({defaults, model, mission, 1}, sst_tree);
  const Plan plan = planner.plan({level_start(), 0, points_of(wall(6))});
  EXPECT_EQ(plan.origin, PlanOrigin::fallback);
  EXPECT_FALSE(plan.points.empty());
  EXPECT_EQ(planner.counts().fallback, 1);
  EXPECT_EQ(total(planner.counts()), 1);
}

TEST(AvoidancePlanner, KeepsItsPlanWhileThatIsGood) {
  PlannerConfig config;
  config.kept_cost_ratio = 100;
  config.refresh_replans = 1000;
  AvoidancePlanner planner({config, model, mission, 1}, sst_tree);
  const std::vector<ObstaclePoint> points = points_of({{{9, 0.1}}});
  const Plan first = planner.plan({level_start(), 0, points});
  ASSERT_EQ(first.origin, PlanOrigin::solved);
  FlightState state = follow_plan(level_start(), first, replan_ns);
  const Plan second = planner.plan({state, replan_ns, points});
  EXPECT_EQ(second.origin, PlanOrigin::kept);
  EXPECT_EQ(planner.counts().searches, 2);  // the second replan improves what the first one found
  state = follow_plan(state, second, replan_ns);
  const Plan third = planner.plan({state, 2 * replan_ns, points});
  EXPECT_EQ(third.origin, PlanOrigin::kept);
  EXPECT_EQ(planner.counts().kept, 2);
  EXPECT_EQ(planner.counts().searches, 2);
  // Kept means the same path: its points are the second plan's, one replan later.
  const std::size_t later = static_cast<std::size_t>(
      std::llround(1e-9 * static_cast<double>(replan_ns) / (first.points[1].t_s - first.points[0].t_s)));
  for (std::size_t i = 0; i + later + 1 < second.points.size(); ++i)
    EXPECT_LT((third.points[i].position_world - second.points[i + later].position_world).norm(), 0.05);
}

TEST(AvoidancePlanner, GivesUpAPlanThatIsBlockedByWhatIsNewlySeen) {
  const PlannerConfig config;
  AvoidancePlanner planner({config, model, mission, 1}, sst_tree);
  std::vector<Trunk> trunks{{{9, 0.1}}};
  const Plan first = planner.plan({level_start(), 0, points_of(trunks)});
  ASSERT_EQ(first.origin, PlanOrigin::solved);
  const PlanPoint& there = first.points[first.points.size() * 3 / 4];
  trunks.push_back({there.position_world.head<2>()});
  const FlightState state = follow_plan(level_start(), first, replan_ns);
  const Plan second = planner.plan({state, replan_ns, points_of(trunks)});
  EXPECT_NE(second.origin, PlanOrigin::kept);
  EXPECT_NE(second.origin, PlanOrigin::straight);
  if (second.origin == PlanOrigin::solved) {
    EXPECT_GT(plan_distance_m(second, trunks, config.field), config.field.wing_radius_m);
  }
}

/// Every tree gets past a trunk, and gives the same plan again.
TEST(AvoidancePlanner, EveryTreeFindsAWayAndRepeatsIt) {
  const std::vector<ObstaclePoint> points = points_of({{{9, 0.1}}, {{12, -1.5}}, {{11, 2}}});
  for (const TreeMaker tree : {sst_tree, rrt_tree, est_tree}) {
    const auto planned = [&](std::uint64_t seed) {
      AvoidancePlanner planner({defaults, model, mission, seed}, tree);
      return planner.plan({level_start(), 0, points});
    };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Plan plan = planned(seed), again = planned(seed);
      EXPECT_EQ(plan.origin, PlanOrigin::solved);
      EXPECT_GE(plan.clearance_m, defaults.trajectory.minimum_clearance_m);
      ASSERT_EQ(plan.points.size(), again.points.size());
      for (std::size_t i = 0; i < plan.points.size(); ++i)
        EXPECT_EQ(plan.points[i].position_world, again.points[i].position_world);
    }
  }
}

TEST(LibraryPlanner, TakesTheWidestWayAndKeepsItWhileItIsSafe) {
  const auto planner = library_planner({defaults, model, mission, 1}, {});
  EXPECT_EQ(planner->plan({level_start(), 0}).origin, PlanOrigin::straight);
  const std::vector<ObstaclePoint> points = points_of({{{9, 0.3}}});
  const Plan first = planner->plan({level_start(), replan_ns, points});
  ASSERT_EQ(first.origin, PlanOrigin::solved);
  EXPECT_GE(first.clearance_m, ManoeuvreLibraryConfig{}.safe_clearance_m);
  EXPECT_LT(first.points[first.points.size() / 2].position_world.y(), 0) << "away from the trunk";
  const FlightState state = follow_plan(level_start(), first, replan_ns);
  EXPECT_EQ(planner->plan({state, 2 * replan_ns, points}).origin, PlanOrigin::kept);
  EXPECT_EQ(planner->plan({level_start(), 3 * replan_ns, points_of(wall(6))}).origin, PlanOrigin::fallback);
  ASSERT_EQ(planner->counts().own.size(), 1u);
  const auto& [name, tried] = planner->counts().own[0];
  EXPECT_EQ(name, "manoeuvres_tried");
  EXPECT_GT(tried, 0);
  EXPECT_EQ(tried % 2, 0) << "the whole library, twice";
}

TEST(StraightPlanner, FliesThroughEverythingAndSaysSo) {
  const auto planner = straight_planner({defaults, model, mission, 1});
  const Plan plan = planner->plan({level_start(), 0, points_of({{{9, 0.1}}})});
  EXPECT_EQ(plan.origin, PlanOrigin::straight);
  EXPECT_LT(plan.clearance_m, 0);
  EXPECT_NEAR(plan.points.back().position_world.y(), 0, 0.01);
  EXPECT_EQ(planner->counts().obstacle_ahead, 1);
  EXPECT_FALSE(planner->concerns({}, plan));
}

TEST(AvoidancePlanner, AReplanCanBeRepeated) {
  std::mt19937_64 generator(5);
  const std::vector<ObstaclePoint> points = points_of(random_forest(generator, 14, 5, 14));
  const auto flown = [&] {
    AvoidancePlanner planner({defaults, model, mission, 9}, sst_tree);
    std::vector<Eigen::Vector3d> path;
    FlightState state = level_start();
    for (int replan = 0; replan < 6; ++replan) {
      const Plan plan = planner.plan({state, replan * replan_ns, points});
      for (const PlanPoint& point : plan.points) path.push_back(point.position_world);
      state = follow_plan(state, plan, replan_ns);
    }
    return path;
  };
  EXPECT_EQ(flown(), flown());
}

}  // namespace
}  // namespace understory
