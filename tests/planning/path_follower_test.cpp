#include "planning/path_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace understory {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

Plan three_commands() {
  Plan plan;
  plan.t_ns = 1'000'000'000;
  for (int i = 0; i < 3; ++i) {
    PlanPoint point;
    point.t_s = 0.1 * i;
    point.bank_command_rad = 0.1 * (i + 1);
    point.climb_command_mps = i;
    plan.points.push_back(point);
  }
  return plan;
}

/// The identified level trim: 12.27 m/s, nose 0.1914 rad above the path (flight records).
State level_state() {
  State state;
  state.T_world_body = AngleAxisd(-0.1914, Vector3d::UnitY());
  state.velocity_body_mps = state.T_world_body.linear().transpose() * Vector3d(12.27, 0, 0);
  return state;
}

Controls follow_command(const FlightCommand& command, const State& state) {
  FlightModelConfig config;
  config.cruise_speed_mps = 12.27;
  return follow(FlightModel(Airframe{}, config), {}, command, state);
}

TEST(CommandAt, IsTheOneInForce) {
  const Plan plan = three_commands();
  EXPECT_EQ(command_at(plan, 0), (FlightCommand{0.1, 0}));  // before the start: the first
  EXPECT_EQ(command_at(plan, 1'000'000'000), (FlightCommand{0.1, 0}));
  EXPECT_EQ(command_at(plan, 1'099'000'000), (FlightCommand{0.1, 0}));
  EXPECT_EQ(command_at(plan, 1'101'000'000), (FlightCommand{0.2, 1}));
  EXPECT_EQ(command_at(plan, 1'250'000'000).climb_mps, 2);
  EXPECT_EQ(command_at(plan, 9'000'000'000).climb_mps, 2);  // after the end: the last
  EXPECT_EQ(command_at(Plan{}, 1), FlightCommand{});        // no plan yet: level flight
}

TEST(Follow, LevelTrimIsLeftAlone) {
  const Controls controls = follow_command({}, level_state());
  EXPECT_NEAR(controls.left_elevon_rad, controls.right_elevon_rad, 1e-9);
  EXPECT_NEAR(controls.left_elevon_rad, 0.1914, 0.06);  // elevons in the wind: as the records' trim
  EXPECT_NEAR(controls.thrust_n, 5.08, 0.3);
}

TEST(Follow, ElevonsGoTheRightWay) {
  const State level = level_state();
  const Controls right = follow_command({0.3, 0}, level);
  EXPECT_LT(right.left_elevon_rad,
            right.right_elevon_rad - 0.05);  // left trailing edge down lifts the left wing
  const Controls left = follow_command({-0.3, 0}, level);
  EXPECT_GT(left.left_elevon_rad, left.right_elevon_rad + 0.05);
  EXPECT_NEAR(left.left_elevon_rad, right.right_elevon_rad, 1e-9);

  const auto collective = [](const Controls& controls) {
    return 0.5 * (controls.left_elevon_rad + controls.right_elevon_rad);
  };
  const double held = collective(follow_command({}, level));
  EXPECT_GT(collective(follow_command({0, 1}, level)), held);  // trailing edges up pitch the nose up
  EXPECT_LT(collective(follow_command({0, -1}, level)), held);
}

TEST(Follow, DampsRatesAndHoldsSpeed) {
  State rolling = level_state();
  rolling.angular_rate_body_radps = {2, 0, 0};  // about the nose: right wing going down
  const Controls against_roll = follow_command({}, rolling);
  EXPECT_GT(against_roll.left_elevon_rad, against_roll.right_elevon_rad);
  State slow = level_state();
  slow.velocity_body_mps *= 0.95;
  EXPECT_GE(follow_command({}, slow).thrust_n, follow_command({}, level_state()).thrust_n);
  State fast = level_state();
  fast.velocity_body_mps *= 1.1;
  EXPECT_LT(follow_command({}, fast).thrust_n, follow_command({}, level_state()).thrust_n);
}

TEST(Follow, StaysWithinTheAirframesLimits) {
  std::mt19937_64 generator(9);
  const auto uniform = [&](double minimum, double maximum) {
    return std::uniform_real_distribution<double>(minimum, maximum)(generator);
  };
  const Airframe airframe;
  const FlightModel model(airframe, {});
  for (int i = 0; i < 5000; ++i) {
    State state;
    state.T_world_body.linear() =
        (AngleAxisd(uniform(-3, 3), Vector3d::UnitZ()) * AngleAxisd(uniform(-1.5, 1.5), Vector3d::UnitY()) *
         AngleAxisd(uniform(-3, 3), Vector3d::UnitX()))
            .toRotationMatrix();
    state.velocity_body_mps = {uniform(0, 18), uniform(-4, 4), uniform(-8, 8)};
    state.angular_rate_body_radps = {uniform(-12, 12), uniform(-8, 8), uniform(-6, 6)};
    const Controls controls = follow(model, {}, {uniform(-1.57, 1.57), uniform(-2, 2)}, state);
    for (const double elevon : {controls.left_elevon_rad, controls.right_elevon_rad}) {
      ASSERT_TRUE(std::isfinite(elevon));
      EXPECT_GE(elevon, airframe.elevon_min_rad);
      EXPECT_LE(elevon, airframe.elevon_max_rad);
    }
    EXPECT_GE(controls.thrust_n, 0);
    EXPECT_LE(controls.thrust_n, airframe.max_thrust_n);
  }
}

}  // namespace
}  // namespace understory
