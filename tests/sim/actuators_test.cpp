#include "sim/aircraft/actuators.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <numbers>

#include "sim/aircraft/aircraft.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;
constexpr double step_s = 1.0 / 1200;

TEST(Actuators, FollowAtOnceByDefault) {
  Actuators actuators({});
  actuators.advance({0.3, -0.2, 4}, step_s);
  EXPECT_EQ(actuators.left_elevon_rad(), 0.3);
  EXPECT_EQ(actuators.right_elevon_rad(), -0.2);
  EXPECT_EQ(actuators.thrust_n(0), 4);
  EXPECT_EQ(actuators.thrust_n(30), 4);
  EXPECT_EQ(actuators.elevon_wash_mps(12, 1.2), 0);
  EXPECT_EQ(actuators.motor_torque_nm(12), 0);
}

TEST(Actuators, LagAnswersAStepExponentially) {
  ActuatorsConfig config;
  config.elevon_time_s = 0.03;
  config.motor_time_s = 0.05;
  Actuators actuators(config);
  actuators.settle({0.1, 0.1, 1});
  for (int i = 1; i <= 240; ++i) {
    actuators.advance({0.6, -0.4, 5}, step_s);
    ASSERT_NEAR(actuators.left_elevon_rad(), 0.6 - 0.5 * std::exp(-i * step_s / 0.03), 1e-12);
    ASSERT_NEAR(actuators.right_elevon_rad(), -0.4 + 0.5 * std::exp(-i * step_s / 0.03), 1e-12);
    ASSERT_NEAR(actuators.thrust_n(12), 5 - 4 * std::exp(-i * step_s / 0.05), 1e-12);
  }
}

TEST(Actuators, RateLimitIsASlope) {
  ActuatorsConfig config;
  config.elevon_rate_radps = 8;
  Actuators actuators(config);
  for (int i = 1; i <= 90; ++i) {
    actuators.advance({0.5, -0.1, 0}, step_s);
    ASSERT_NEAR(actuators.left_elevon_rad(), std::min(0.5, 8 * step_s * i), 1e-12);
    ASSERT_NEAR(actuators.right_elevon_rad(), std::max(-0.1, -8 * step_s * i), 1e-12);
  }
}

// With both, the lag asks for (command - position) / time: the rate limit rules until that falls below it,
// rate * time before the command, and the exponential the rest.
TEST(Actuators, RateLimitGivesWayToTheLag) {
  ActuatorsConfig config;
  config.elevon_time_s = 0.03;
  config.elevon_rate_radps = 8;
  Actuators actuators(config);
  const double handover_s = (0.8 - 8 * 0.03) / 8;
  for (int i = 1; i <= 240; ++i) {
    actuators.advance({0.8, 0, 0}, step_s);
    const double t_s = i * step_s;
    const double expected =
        t_s < handover_s ? 8 * t_s : 0.8 - 8 * 0.03 * std::exp(-(t_s - handover_s) / 0.03);
    ASSERT_NEAR(actuators.left_elevon_rad(), expected, 8 * step_s * step_s / 0.03);  // one step's curvature
  }
}

TEST(Actuators, ThrustFallsLinearlyToThePitchSpeed) {
  ActuatorsConfig config;
  config.pitch_speed_mps = 21;
  config.thrust_speed_mps = 12.27;
  Actuators actuators(config);
  actuators.settle({0, 0, 5});
  EXPECT_DOUBLE_EQ(actuators.thrust_n(12.27), 5);  // what was commanded, where the model was identified
  EXPECT_DOUBLE_EQ(actuators.thrust_n(0), 5 * 21 / (21 - 12.27));
  EXPECT_NEAR(actuators.thrust_n(12.27 + (21 - 12.27) / 2), 2.5, 1e-12);
  EXPECT_EQ(actuators.thrust_n(21), 0);
  EXPECT_EQ(actuators.thrust_n(25), 0);
}

// Momentum theory, checked by its own balance: thrust = mass flow through the disc times the wake's speed.
TEST(Actuators, WashCarriesTheThrustsMomentum) {
  ActuatorsConfig config;
  config.propwash_share = 1;
  Actuators actuators(config);
  actuators.settle({0, 0, 5});
  const double disc_m2 = std::numbers::pi * 0.09 * 0.09;
  for (const double speed : {0.0, 5.0, 12.0}) {
    const double wash = actuators.elevon_wash_mps(speed, 1.204);
    EXPECT_NEAR(1.204 * disc_m2 * (speed + wash / 2) * wash, 5, 1e-9) << speed;
  }
  config.propwash_share = 0.1;
  Actuators grazed(config);
  grazed.settle({0, 0, 5});
  EXPECT_NEAR(grazed.elevon_wash_mps(12, 1.204), 0.1 * actuators.elevon_wash_mps(12, 1.204), 1e-12);
}

Eigen::Isometry3d high_up() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 500;
  return pose;
}

// In a vacuum nothing but the torque acts about the body's x: left wing down at Q / I, in the house's axes
// (x forward, z up) a negative rate.
TEST(Actuators, MotorTorqueRollsTheAircraft) {
  Airframe airframe;
  airframe.air_density_kgpm3 = 1e-12;
  airframe.rate_damping_nmspr.setZero();
  ActuatorsConfig config;
  config.torque_per_thrust_m = 0.014;
  const World world = build_world(UNDERSTORY_SOURCE_DIR "/models", airframe, {}, WorldConfig{});
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Wind(Vector3d::Zero()), config);
  aircraft.place(high_up(), Vector3d::Zero(), Vector3d::Zero(), {0, 0, 5});
  for (int i = 0; i < 600; ++i) aircraft.step({0, 0, 5});
  EXPECT_NEAR(aircraft.truth().angular_rate_body_radps.x(), -0.5 * 0.014 * 5 / airframe.inertia_kgm2.x(),
              1e-6);
}

// Lag and limit stand behind the input delay, in truth, in the drawn hinge, and in what the air feels.
TEST(Actuators, TheAircraftFliesWithThem) {
  const Airframe airframe;
  ActuatorsConfig config;
  config.elevon_time_s = 0.03;
  config.motor_time_s = 0.05;
  config.pitch_speed_mps = 21;
  const World world = build_world(UNDERSTORY_SOURCE_DIR "/models", airframe, {}, WorldConfig{});
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Wind(Vector3d::Zero()), config);
  aircraft.place(high_up(), {12.27, 0, 0}, Vector3d::Zero(), {});
  for (int i = 0; i < 24 + 36; ++i) aircraft.step({0.5, 0.5, 5});  // the delay, then 30 ms
  EXPECT_NEAR(aircraft.truth().left_elevon_rad, 0.5 * (1 - std::exp(-1.0)), 1e-9);
  const int joint = mj_name2id(world.model.get(), mjOBJ_JOINT, "left_elevon");
  EXPECT_EQ(aircraft.data().qpos[world.model->jnt_qposadr[joint]], aircraft.truth().left_elevon_rad);
  const Truth& truth = aircraft.truth();
  const double forward_mps = (truth.T_world_body.linear().transpose() * truth.velocity_world_mps).x();
  EXPECT_NEAR(truth.thrust_n, 5 * (1 - std::exp(-0.6)) * (21 - forward_mps) / (21 - 12.27), 1e-9);
}

}  // namespace
}  // namespace understory
