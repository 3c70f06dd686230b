#include "planning/manoeuvre.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/forests.hpp"

namespace understory {
namespace {

/// A task whose parts live as long as it does.
struct Flight {
  explicit Flight(const std::vector<Trunk>& trunks = {}) : field({}, points_of(trunks), 0) {
    start.position_world.z() = mission.cruise_altitude_m;
  }
  FlightTask task() const { return {model, config, mission, field, start.position_world}; }

  FlightModel model{Airframe{}, FlightModelConfig{}};
  TrajectoryConfig config;
  Mission mission;
  ObstacleField field;
  FlightState start;
};

TEST(FlyOut, ReachesTheHorizonInFreeSpace) {
  const Flight flight;
  const Rollout rollout = fly_out(flight.task(), flight.start, {}, 0.05, true);
  EXPECT_TRUE(rollout.reached_horizon);
  ASSERT_GE(rollout.points.size(), 3u);
  EXPECT_EQ(rollout.points.front().position_world, flight.start.position_world);
  EXPECT_GE(rollout.points.back().position_world.x(), flight.config.horizon_m);
  EXPECT_LT(rollout.points[rollout.points.size() - 2].position_world.x(), flight.config.horizon_m);
  for (std::size_t i = 0; i < rollout.points.size(); ++i)
    EXPECT_NEAR(rollout.points[i].t_s, flight.config.step_s * static_cast<double>(i), 1e-9);
  EXPECT_NEAR(rollout.free_until_s, rollout.points.back().t_s, 1e-6);
  EXPECT_NEAR(rollout.points.back().position_world.z(), flight.mission.cruise_altitude_m, 0.3);
}

TEST(FlyOut, StopsBeforeAnObstacle) {
  const Flight flight(wall(8));
  const double minimum_m = 0.2;
  const Rollout rollout = fly_out(flight.task(), flight.start, {}, minimum_m, true);
  EXPECT_FALSE(rollout.reached_horizon);
  EXPECT_LT(rollout.minimum_clearance_m, minimum_m);
  EXPECT_LT(rollout.points.back().position_world.x(), 8.0);
  EXPECT_LT(rollout.free_until_s, 8.0 / 11.0);
  // The manoeuvre is free at its last free moment.
  const PlanPoint& before = rollout.points[rollout.points.size() - 2];
  EXPECT_NEAR(before.t_s, rollout.free_until_s, 1e-9);
  EXPECT_LT(before.position_world.x(), 8.0 - minimum_m);
}

TEST(FlyOut, FliesThroughWhereToldTo) {
  const Flight flight(wall(8));
  const Rollout rollout = fly_out(flight.task(), flight.start, {}, 0.2, true, false);
  EXPECT_FALSE(rollout.reached_horizon);
  EXPECT_GE(rollout.points.back().position_world.x(), flight.config.horizon_m);
  EXPECT_LT(rollout.minimum_clearance_m, 0);
  EXPECT_LT(rollout.free_until_s, 8.0 / 11.0);
}

TEST(FlyOut, StopsWhereTheBandEnds) {
  Flight flight;
  flight.start.position_world.z() = flight.mission.maximum_altitude_m - 0.15;
  flight.start.climb_angle_rad = 0.15;
  const Rollout rollout = fly_out(flight.task(), flight.start, {{{0, 2}, 2.0}}, 0.05, true);
  EXPECT_FALSE(rollout.reached_horizon);
  EXPECT_LT(rollout.minimum_margin_m, 0.05);
  EXPECT_GE(rollout.minimum_clearance_m, flight.config.comfortable_clearance_m);  // no obstacle far and wide
  EXPECT_LT(rollout.points.back().position_world.x(), flight.config.horizon_m);
}

TEST(FlyOut, HoldsEachCommandForItsTime) {
  const Flight flight;
  const Manoeuvre manoeuvre{{{0.5, 0}, 0.2}, {{-0.4, 1}, 0.1}};
  const Rollout rollout = fly_out(flight.task(), flight.start, manoeuvre, 0.05, true);
  for (const PlanPoint& point : rollout.points) {
    if (point.t_s < 0.199) {
      EXPECT_EQ(point.bank_command_rad, 0.5);
    } else if (point.t_s < 0.299) {
      EXPECT_EQ(point.bank_command_rad, -0.4);
      EXPECT_EQ(point.climb_command_mps, 1);
    } else {
      EXPECT_NE(point.climb_command_mps, 1);
    }
  }
}

TEST(FlyOut, NearerObstaclesCostMore) {
  const Flight beside({{{8, 0.9}}}), clear;
  EXPECT_GT(fly_out(beside.task(), beside.start, {}, -1, false).cost,
            fly_out(clear.task(), clear.start, {}, -1, false).cost);
}

TEST(CourseCommand, TurnsBackToTheCourse) {
  Flight flight;
  EXPECT_NEAR(course_command(flight.task(), flight.start).bank_rad, 0, 1e-9);
  flight.start.heading_rad = 0.3;  // pointing left of the course: bank right
  EXPECT_GT(course_command(flight.task(), flight.start).bank_rad, 0.1);
  flight.start.heading_rad = 0;
  flight.start.position_world.y() = flight.mission.half_width_m - 1;  // at the left side: turn right, inwards
  EXPECT_GT(course_command(flight.task(), flight.start).bank_rad, 0.1);
  flight.start.position_world = {0, 0, flight.mission.cruise_altitude_m - 1};
  EXPECT_GT(course_command(flight.task(), flight.start).climb_mps, 0.1);
}

}  // namespace
}  // namespace understory
