#include "planning/autopilot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "planning/avoidance_planner.hpp"
#include "planning/path_follower.hpp"
#include "tests/perception/rigs.hpp"

/// When the autopilot plans, in level flight at 12 m/s along x with a pair of images and a call of replan()
/// at 120 Hz; and how it follows a plan.
namespace understory {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double speed_mps = 12;
std::int64_t time_of_tick_ns(std::int64_t tick) { return 1'000'000'000 + tick * 25'000'000 / 3; }

class LevelFlight : public StateSource {
 public:
  void fly_to(std::int64_t t_ns) { state_ = state_at(t_ns); }
  State state_at(std::int64_t t_ns) const override {
    State state;
    state.t_ns = t_ns;
    state.distance_flown_m = 1e-9 * static_cast<double>(t_ns) * speed_mps;
    state.T_world_body.translation() = Vector3d(state.distance_flown_m, 0, Mission{}.cruise_altitude_m);
    state.velocity_body_mps.x() = speed_mps;
    state.altitude_m = Mission{}.cruise_altitude_m;
    return state;
  }
  const State& state() const override { return state_; }
  void on(const Sample&) override {}

 private:
  State state_;
};

class GivenHits : public ObstacleDetector {
 public:
  const std::vector<StereoHit>& detect(const StereoFrame&) override { return hits; }
  std::vector<StereoHit> hits;
};

struct Flight {
  explicit Flight(const AutopilotConfig& config)
      : planner({config.planner, FlightModel({}, config.flight_model), Mission{}, 1}, sst_tree),
        autopilot(config, Airframe{}, rig, detector, state_source, planner) {
    for (const std::int64_t sample_ns : {0, 1})
      autopilot.on(ImuSample{sample_ns, Vector3d::Zero(), {100, 0, 0}});
  }

  int plans() const { return static_cast<int>(autopilot.counts().replans); }

  /// Sees `points_world` at each tick; how many plans that makes.
  int fly(int ticks, const std::vector<Vector3d>& points_world = {}) {
    const int before = plans();
    for (int i = 0; i < ticks; ++i, ++tick) {
      const std::int64_t t_ns = time_of_tick_ns(tick);
      state_source.fly_to(t_ns);
      detector.hits.clear();
      const Eigen::Isometry3d T_world_camera = state_source.state().T_world_body * rig.T_body_camera;
      for (const Vector3d& point : points_world) {
        StereoHit hit;
        hit.position_camera = T_world_camera.inverse() * point;
        detector.hits.push_back(hit);
      }
      autopilot.on(StereoFrame{t_ns, {}, {}});
      autopilot.replan(t_ns);
      autopilot.controls(time_of_tick_ns(tick + 1) - 1);  // takes the plan up
    }
    return plans() - before;
  }

  /// Flies until one tick after a plan, and says how far.
  double after_a_plan_m() {
    fly(13);
    return state_source.state().distance_flown_m;
  }

  StereoRig rig = support::house_rig("long.yaml");
  GivenHits detector;
  LevelFlight state_source;
  AvoidancePlanner planner;
  Autopilot autopilot;
  std::int64_t tick = 0;
};

AutopilotConfig seldom() {
  AutopilotConfig config;
  config.straight_period_s = 0.1;
  config.avoiding_period_s = 0.025;
  return config;
}

/// A trunk's points, abreast of the course by that much.
std::vector<Vector3d> trunk_at(double x_m, double abreast_m) {
  return {{x_m, abreast_m, 4.2}, {x_m, abreast_m, 4.5}, {x_m, abreast_m, 4.8}};
}

TEST(Autopilot, PlansAtEveryCallWhereNoPeriodIsSet) {
  Flight flight{AutopilotConfig{}};
  EXPECT_EQ(flight.fly(120), 120);
}

TEST(Autopilot, PlansOncePerPeriodWhileNothingIsNew) {
  Flight flight(seldom());
  EXPECT_EQ(flight.fly(120), 10);
}

TEST(Autopilot, PlansAtOnceForWhatComesNearTheWay) {
  Flight flight(seldom());
  const double x_m = flight.after_a_plan_m() + 9;
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 0.1)), 1);
  EXPECT_NE(flight.autopilot.plan().origin, PlanOrigin::straight);
}

TEST(Autopilot, WhatIsKnownOrFarAsideIsNoReasonToPlan) {
  Flight flight(seldom());
  const double x_m = flight.after_a_plan_m() + 9;
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 5)), 0);
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 1.1)), 1);  // near, if not in the way
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 1.1)), 0);
}

TEST(Autopilot, LooksAfterAManoeuvreMoreOftenThanAfterTheStraightWay) {
  Flight flight(seldom());
  const double x_m = flight.after_a_plan_m() + 9;
  flight.fly(1, trunk_at(x_m, 0.1));
  EXPECT_EQ(flight.fly(30), 10);
}

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
  return follow(FlightModel(Airframe{}, {.cruise_speed_mps = 12.27}), {}, command, state);
}

/// Plans straight on, and shows what it was asked.
class Asked : public Planner {
 public:
  Plan plan(const PlanRequest& request) override {
    last = request;
    ++counts_.replans;
    counts_.model_steps += 1000;
    return {request.t_ns, PlanOrigin::straight, {{0, request.start.position_world}}, INFINITY};
  }
  PlanRequest last;
};

/// The fix says that the aircraft is 3 m left of where it thinks: the planner works there, the plan and the
/// map stay where odometry has them.
TEST(Autopilot, PlansBesideTheCoursesOwnLineWhereGpsSaysWhereItIs) {
  const StereoRig rig = support::house_rig("long.yaml");
  GivenHits detector;
  LevelFlight source;
  Asked planner;
  Autopilot autopilot({}, Airframe{}, rig, detector, source, planner);
  for (const std::int64_t sample_ns : {0, 1})
    autopilot.on(ImuSample{sample_ns, Vector3d::Zero(), {100, 0, 0}});
  std::int64_t t_ns = 1'000'000'000;
  source.fly_to(t_ns);
  const Eigen::Isometry3d T_world_camera = source.state().T_world_body * rig.T_body_camera;
  for (const Vector3d& point : trunk_at(22, 1)) {
    detector.hits.emplace_back();
    detector.hits.back().position_camera = T_world_camera.inverse() * point;
  }
  for (int tick = 0; tick < 3; ++tick) autopilot.on(StereoFrame{t_ns + tick, {}, {}});
  autopilot.on(GpsSample{t_ns - 200'000'000,
                         source.state_at(t_ns - 200'000'000).T_world_body.translation() + Vector3d(0, 3, 9)});
  autopilot.replan(t_ns);
  autopilot.controls(t_ns += 10'000'000);
  EXPECT_NEAR(planner.last.start.position_world.y(), 3, 1e-6);
  ASSERT_FALSE(planner.last.points.empty());
  for (const ObstaclePoint& point : planner.last.points) {
    EXPECT_NEAR(point.position_world.y(), 4, 1e-6);
    EXPECT_LT(point.position_world.z(), 5);  // heights are the barometer's business
  }
  ASSERT_FALSE(autopilot.plan().points.empty());
  EXPECT_NEAR(autopilot.plan().points[0].position_world.y(), 0, 1e-6);
  for (const ObstaclePoint& point : autopilot.map().points()) EXPECT_NEAR(point.position_world.y(), 1, 1e-6);
}

/// A plan of 1000 steps is in force after them and not before; meanwhile no other is made.
TEST(Autopilot, APlanIsReadyWhenItsWorkIsDone) {
  const StereoRig rig = support::house_rig("long.yaml");
  for (const auto& [step_s, ready_s] : {std::pair(0.0, 0.006), {5e-7, 0.006}, {5e-5, 0.05}}) {
    GivenHits detector;
    LevelFlight source;
    Asked planner;
    AutopilotConfig config;
    config.plan_cost.step_s = step_s;
    Autopilot autopilot(config, Airframe{}, rig, detector, source, planner);
    for (const std::int64_t sample_ns : {0, 1})
      autopilot.on(ImuSample{sample_ns, Vector3d::Zero(), {100, 0, 0}});
    const std::int64_t asked_ns = 1'000'000'000, ready_ns = asked_ns + nanoseconds(ready_s);
    source.fly_to(asked_ns);
    autopilot.replan(asked_ns);
    for (std::int64_t t_ns = asked_ns; t_ns < ready_ns; t_ns += 1'000'000) {
      source.fly_to(t_ns);
      autopilot.controls(t_ns);
      autopilot.replan(t_ns);
      EXPECT_TRUE(autopilot.plan().points.empty());
      EXPECT_EQ(planner.counts().replans, 1);
    }
    source.fly_to(ready_ns);
    autopilot.controls(ready_ns);
    EXPECT_FALSE(autopilot.plan().points.empty());
    EXPECT_LT(autopilot.plan().t_ns, asked_ns + 50'000'000);  // made for the latency that is expected
  }
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
