#include "sim/scene/world.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>

#include "sim/aircraft/aircraft.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

const char* const models = UNDERSTORY_SOURCE_DIR "/models";

Obstacle trunk(double x_m, double y_m, double radius_m = 0.15) {
  return {"trunk", {x_m, y_m, -0.2}, {x_m, y_m, 8}, radius_m, 0, 0};
}

/// What the aircraft touches at 3 m height above (0, 0), banked so far, among these obstacles.
Contact touched(const std::vector<Obstacle>& obstacles, double bank_rad, double altitude_m = 3,
                const WorldConfig& config = {}) {
  const Airframe airframe;
  const World world = build_world(models, airframe, obstacles, config);
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  Eigen::Isometry3d pose(Eigen::AngleAxisd(bank_rad, Vector3d::UnitX()));
  pose.translation() = Vector3d(0, 0, altitude_m);
  aircraft.place(pose, {12, 0, 0}, Vector3d::Zero(), {});
  return aircraft.contact();
}

constexpr double right_angle = std::numbers::pi / 2;

TEST(World, WingOnEdgePassesWhereALevelOneDoesNot) {
  // Free between the trunks: 0.6 m, less than the span of 0.86 m, more than the winglets' height.
  const std::vector<Obstacle> gap = {trunk(-0.08, 0.45), trunk(-0.08, -0.45)};
  EXPECT_EQ(touched(gap, 0), Contact::obstacle);
  EXPECT_EQ(touched(gap, right_angle), Contact::none);
  EXPECT_EQ(touched(gap, -right_angle), Contact::none);
}

TEST(World, CollisionOutlineIsTheSpan) {
  for (const double side : {-1.0, 1.0}) {
    EXPECT_EQ(touched({trunk(-0.08, side * (0.4318 + 0.15 + 0.005))}, 0), Contact::none);
    EXPECT_EQ(touched({trunk(-0.08, side * (0.4318 + 0.15 - 0.005))}, 0), Contact::obstacle);
  }
}

TEST(World, NoseMeetsTheTrunkAhead) {
  EXPECT_EQ(touched({trunk(0.2 + 0.15 - 0.01, 0)}, 0), Contact::obstacle);
  EXPECT_EQ(touched({trunk(0.2 + 0.15 + 0.01, 0)}, 0), Contact::none);
}

TEST(World, CrossbarsCollideToo) {
  const Obstacle bar{"crossbar", {0, -2, 3.0}, {0, 2, 3.0}, 0.05, 0, 0};
  EXPECT_EQ(touched({bar}, 0), Contact::obstacle);
  EXPECT_EQ(touched({bar}, 0, 3.5), Contact::none);
}

TEST(World, WallsCollideOverTheirWholeFace) {
  Obstacle wall{"wall", {0.6, -8, 0}, {0.6, 8, 6}, 0.2, 0, 0, ObstacleKind::wall};
  EXPECT_EQ(touched({wall}, 0), Contact::none);  // 0.4 m ahead of the centre of mass: the nose is shorter
  wall.from_world.x() = wall.to_world.x() = 0.3;
  EXPECT_EQ(touched({wall}, 0), Contact::obstacle);
  EXPECT_EQ(touched({wall}, 0, 5.9), Contact::obstacle);
  EXPECT_EQ(touched({wall}, 0, 6.5), Contact::none);
  wall.from_world.y() = 3;
  EXPECT_EQ(touched({wall}, 0), Contact::none);
  const Obstacle turned{"wall", {-3, -2.6, 0},     {3, 3.4, 6}, 0.05, 0,
                        0,      ObstacleKind::wall};  // 0.28 m off, at 45 deg
  EXPECT_EQ(touched({turned}, 0), Contact::obstacle);
}

TEST(World, GroundIsTheGround) {
  EXPECT_EQ(touched({}, 0, 0.01), Contact::ground);
  EXPECT_EQ(touched({}, 0, 0.05), Contact::none);
  EXPECT_EQ(touched({}, right_angle, 0.4), Contact::ground);  // a wing tip
}

TEST(World, IntangibleObstaclesAreHarmless) {
  WorldConfig config;
  config.obstacles_tangible = false;
  EXPECT_EQ(touched({trunk(0, 0)}, 0, 3, config), Contact::none);
}

TEST(World, InvisibleObstaclesStillCollide) {
  WorldConfig config;
  config.obstacles_visible = false;
  EXPECT_EQ(touched({trunk(0, 0)}, 0, 3, config), Contact::obstacle);
}

TEST(World, ObstaclesRestOnTheGroundInPeace) {
  const World world = build_world(models, Airframe{}, {trunk(20, 0), trunk(20, 0.1)}, WorldConfig{});
  const DataPointer data(mj_makeData(world.model.get()));
  data->qpos[2] = 5;
  mj_forward(world.model.get(), data.get());
  EXPECT_EQ(data->ncon, 0);
}

TEST(World, NoContactIsMissedInFlight) {
  // The aircraft leaves MuJoCo's collision stage out where nothing is near: its answer must be MuJoCo's at
  // every step.
  std::vector<Obstacle> forest;
  for (int i = 0; i < 6; ++i) forest.push_back(trunk(3.0 + 2.5 * i, i % 2 == 0 ? 0.9 : -0.7));
  forest.push_back({"fallen", {18, -3, 1}, {21, 3, 4}, 0.1, 0, 0});
  const Airframe airframe;
  const World world = build_world(models, airframe, forest, WorldConfig{});
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  const DataPointer plain(mj_makeData(world.model.get()));
  Eigen::Isometry3d pose(Eigen::AngleAxisd(-0.19, Vector3d::UnitY()));
  pose.translation() = Vector3d(0, 0, 3);
  aircraft.place(pose, {12.3, 0, 0}, Vector3d::Zero(), {0.19, 0.19, 5});
  int touching = 0, near_miss = 0;
  for (int step = 0; step < 4 * physics_rate_hz; ++step) {
    const double turn = 0.15 * std::sin(0.01 * step);
    aircraft.step({0.19 + turn, 0.19 - turn, 3});
    std::copy_n(aircraft.data().qpos, world.model->nq, plain->qpos);
    mj_kinematics(world.model.get(), plain.get());
    mj_comPos(world.model.get(), plain.get());
    mj_collision(world.model.get(), plain.get());
    ASSERT_EQ(plain->ncon, aircraft.data().ncon) << "at step " << step;
    (aircraft.contact() == Contact::none ? near_miss : touching) += 1;
  }
  EXPECT_GT(touching, 10);
  EXPECT_GT(near_miss, 10);
}

/// A large course against worlds of few obstacles, which hold a geom for each.
TEST(World, PooledCapsulesOfALargeCourseCollideAsAllOfThemWould) {
  std::vector<Obstacle> trunks;
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 800; ++i) trunks.push_back(trunk(100 * unit(generator), 10 * unit(generator)));
  const Airframe airframe;
  const World large = build_world(models, airframe, trunks, {});
  ASSERT_NE(large.flown, nullptr);
  EXPECT_GT(large.model->ngeom, 800);  // drawn
  Aircraft pooled(large.flown_model(), airframe, LaunchConfig{}, Wind(Vector3d::Zero()), {}, trunks);
  int touches = 0;
  for (double x_m = 5; x_m < 100; x_m += 10) {
    std::vector<Obstacle> near;
    std::ranges::copy_if(trunks, std::back_inserter(near),
                         [&](const Obstacle& one) { return std::abs(one.from_world.x() - x_m) < 8; });
    const World small = build_world(models, airframe, near, {});
    ASSERT_EQ(small.flown, nullptr);
    Aircraft full(*small.model, airframe, LaunchConfig{}, Vector3d::Zero());
    for (int i = 0; i < 200; ++i) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(3 * unit(generator), Vector3d::UnitX()));
      pose.translation() =
          Vector3d(x_m - 5 + 10 * unit(generator), 10 * unit(generator), 1 + 8 * unit(generator));
      for (Aircraft* aircraft : {&pooled, &full}) aircraft->place(pose, {12, 0, 0}, Vector3d::Zero(), {});
      ASSERT_EQ(pooled.contact(), full.contact()) << pose.translation().transpose();
      touches += full.contact() == Contact::obstacle;
    }
  }
  EXPECT_GT(touches, 200);
  EXPECT_LT(touches, 1800);
}

TEST(World, StepAndViewArePinned) {
  const World small = build_world(models, Airframe{}, {}, WorldConfig{});
  const World large = build_world(models, Airframe{}, {trunk(200, 90)}, WorldConfig{});
  EXPECT_DOUBLE_EQ(small.model->opt.timestep, 1.0 / 1200);
  EXPECT_EQ(small.model->vis.quality.offsamples, 0);
  for (const World* world : {&small, &large}) {
    EXPECT_NEAR(world->model->vis.map.znear * world->model->stat.extent, 0.1, 1e-6);
    EXPECT_NEAR(world->model->vis.map.zfar * world->model->stat.extent, 120, 1e-4);
  }
}

TEST(World, AircraftsFileOpensByItself) {
  char message[1000] = "";
  const std::string file = std::string(models) + "/airframe/delta_wing.xml";
  const ModelPointer model(mj_loadXML(file.c_str(), nullptr, message, sizeof message));
  ASSERT_TRUE(model) << message;
  EXPECT_NEAR(mj_getTotalmass(model.get()), Airframe{}.mass_kg, 1e-7);
}

TEST(World, MissingModelIsNamed) {
  try {
    build_world("/proc/nowhere", Airframe{}, {}, WorldConfig{});
    FAIL() << "a missing model must not build";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/nowhere/airframe/delta_wing.xml"), std::string::npos);
  }
}

TEST(World, MuJoCosErrorsAreRaised) {
  const World world = build_world(models, Airframe{}, {}, WorldConfig{});
  EXPECT_THROW(mju_error("made up"), std::runtime_error);
}

}  // namespace
}  // namespace understory
