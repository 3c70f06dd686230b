#include "planning/autopilot.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/perception/rigs.hpp"

/// When the autopilot plans: level flight at 12 m/s along x, a pair of images and a call of replan() at
/// 120 Hz.
namespace understory {
namespace {

constexpr double speed_mps = 12;
std::int64_t time_of_tick_ns(std::int64_t tick) { return 1'000'000'000 + tick * 25'000'000 / 3; }

class LevelFlight : public StateSource {
 public:
  void fly_to(std::int64_t t_ns) { state_ = state_at(t_ns); }
  State state_at(std::int64_t t_ns) const override {
    State state;
    state.t_ns = t_ns;
    state.distance_flown_m = 1e-9 * static_cast<double>(t_ns) * speed_mps;
    state.T_world_body.translation() =
        Eigen::Vector3d(state.distance_flown_m, 0, Mission{}.cruise_altitude_m);
    state.velocity_body_mps.x() = speed_mps;
    state.altitude_m = Mission{}.cruise_altitude_m;
    return state;
  }
  const State& state() const override { return state_; }
  void on(const ImuSample&) override {}
  void on(const PitotSample&) override {}
  void on(const BarometerSample&) override {}
  void on(const MagnetometerSample&) override {}
  void on(const GpsSample&) override {}
  void on(const ResightingSample&) override {}

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
      : autopilot(config, Airframe{}, rig, Mission{}, detector, state_source, 1) {
    for (const std::int64_t sample_ns : {0, 1}) autopilot.on(ImuSample{sample_ns, {}, {100, 0, 0}});
  }

  int plans() const { return static_cast<int>(autopilot.counts().replans); }

  /// Sees `points_world` at each tick; how many plans that makes.
  int fly(int ticks, const std::vector<Eigen::Vector3d>& points_world = {}) {
    const int before = plans();
    for (int i = 0; i < ticks; ++i, ++tick) {
      const std::int64_t t_ns = time_of_tick_ns(tick);
      state_source.fly_to(t_ns);
      detector.hits.clear();
      const Eigen::Isometry3d T_world_camera = state_source.state().T_world_body * rig.T_body_camera;
      for (const Eigen::Vector3d& point : points_world) {
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

  StereoRig rig = support::house_rig("long.yaml");
  GivenHits detector;
  LevelFlight state_source;
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
std::vector<Eigen::Vector3d> trunk_at(double x_m, double abreast_m) {
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
  flight.fly(13);  // one tick after a plan
  const double x_m = flight.state_source.state().distance_flown_m + 9;
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 0.1)), 1);
  EXPECT_NE(flight.autopilot.plan().origin, PlanOrigin::straight);
}

TEST(Autopilot, WhatIsKnownOrFarAsideIsNoReasonToPlan) {
  Flight flight(seldom());
  flight.fly(13);
  const double x_m = flight.state_source.state().distance_flown_m + 9;
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 5)), 0);
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 1.3)), 1);  // near, if not in the way
  EXPECT_EQ(flight.fly(1, trunk_at(x_m, 1.3)), 0);
}

TEST(Autopilot, LooksAfterAManoeuvreMoreOftenThanAfterTheStraightWay) {
  Flight flight(seldom());
  flight.fly(13);
  const double x_m = flight.state_source.state().distance_flown_m + 9;
  flight.fly(1, trunk_at(x_m, 0.1));
  EXPECT_EQ(flight.fly(30), 10);
}

}  // namespace
}  // namespace understory
