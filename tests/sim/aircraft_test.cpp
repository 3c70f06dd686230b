#include "sim/aircraft/aircraft.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cmath>

#include "perception/field_visitor.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "sim/aircraft/aircraft_config.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

World empty_world(const Airframe& airframe) {
  return build_world(UNDERSTORY_SOURCE_DIR "/models", airframe, {}, WorldConfig{});
}

Eigen::Isometry3d level_pose(double pitch_rad, double altitude_m) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(-pitch_rad, Vector3d::UnitY()));
  pose.translation() = Vector3d(0, 0, altitude_m);
  return pose;
}

double attack_of(const Truth& truth) {
  const Vector3d velocity_body = truth.T_world_body.linear().transpose() * truth.velocity_world_mps;
  return std::atan2(-velocity_body.z(), velocity_body.x());
}

/// No air at all: what is left is MuJoCo's rigid body.
Airframe in_vacuum() {
  Airframe airframe;
  airframe.air_density_kgpm3 = 1e-12;
  airframe.rate_damping_nmspr.setZero();
  return airframe;
}

struct FlyingAircraft : testing::Test {
  const Airframe airframe;
  const World world = empty_world(airframe);
};

TEST(Aircraft, MassAndInertiaAreTheAirframes) {
  Airframe airframe;
  airframe.mass_kg = 0.7;
  const World world = empty_world(airframe);
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  const int body = mj_name2id(world.model.get(), mjOBJ_BODY, "aircraft");
  EXPECT_NEAR(world.model->body_subtreemass[body], 0.7, 1e-7);
  // The free joint's own block of the mass matrix, as MuJoCo sums it.
  std::vector<mjtNum> matrix(static_cast<std::size_t>(world.model->nv * world.model->nv));
  mj_fullM(world.model.get(), matrix.data(), aircraft.data().qM);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(matrix[static_cast<std::size_t>(i * world.model->nv + i)], 0.7, 1e-7);
    EXPECT_NEAR(matrix[static_cast<std::size_t>((3 + i) * world.model->nv + 3 + i)], airframe.inertia_kgm2[i],
                1e-9);
  }
}

TEST(Aircraft, FallsFreelyWithoutAir) {
  const Airframe airframe = in_vacuum();
  const World world = empty_world(airframe);
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  aircraft.place(level_pose(0, 100), {10, 0, 0}, Vector3d::Zero(), {});
  for (int i = 0; i < physics_rate_hz; ++i) aircraft.step({});
  const Vector3d place = aircraft.truth().T_world_body.translation();
  EXPECT_NEAR(place.x(), 10, 1e-6);
  EXPECT_NEAR(place.z(), 100 - 0.5 * 9.81, 0.5 * 9.81 / physics_rate_hz * 1.01);  // Euler's own half step
  EXPECT_NEAR(aircraft.truth().velocity_world_mps.z(), -9.81, 1e-6);
  EXPECT_LT(aircraft.truth().specific_force_body_mps2.norm(), 1e-6);  // feels nothing
}

TEST(Aircraft, TorqueFreeTumbleKeepsMomentumAndEnergy) {
  const Airframe airframe = in_vacuum();
  const World world = empty_world(airframe);
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  aircraft.place(level_pose(0, 1000), Vector3d::Zero(), {1, 2, 3}, {});
  const auto momentum_world = [&] {
    const Truth& truth = aircraft.truth();
    return Vector3d(truth.T_world_body.linear() *
                    airframe.inertia_kgm2.cwiseProduct(truth.angular_rate_body_radps));
  };
  const auto energy = [&] {
    const Vector3d& rate = aircraft.truth().angular_rate_body_radps;
    return 0.5 * rate.dot(airframe.inertia_kgm2.cwiseProduct(rate));
  };
  const Vector3d momentum = momentum_world();
  const double start = energy();
  for (int i = 0; i < physics_rate_hz; ++i) aircraft.step({});
  EXPECT_LT((momentum_world() - momentum).norm(), 0.01 * momentum.norm());
  EXPECT_NEAR(energy(), start, 0.01 * start);
}

TEST_F(FlyingAircraft, HoldsTheTrimItWasGiven) {
  const Trim trim = straight_trim(airframe, 12.27).value();
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  const Controls held{trim.elevon_rad, trim.elevon_rad, trim.thrust_n};
  aircraft.place(level_pose(trim.angle_of_attack_rad, 50), {12.27, 0, 0}, Vector3d::Zero(), held);
  for (int i = 0; i < 5 * physics_rate_hz; ++i) {
    aircraft.step(held);
    ASSERT_NEAR(aircraft.truth().velocity_world_mps.norm(), 12.27, 0.05) << "at step " << i;
    ASSERT_NEAR(attack_of(aircraft.truth()), trim.angle_of_attack_rad, 0.005) << "at step " << i;
    ASSERT_NEAR(aircraft.truth().velocity_world_mps.z(), 0, 0.05) << "at step " << i;
  }
  EXPECT_NEAR(aircraft.truth().specific_force_body_mps2.norm(), 9.81, 0.02);  // level: weight alone
}

TEST_F(FlyingAircraft, ShortPeriodSettles) {
  const Trim trim = straight_trim(airframe, 12.27).value();
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  const Controls held{trim.elevon_rad, trim.elevon_rad, trim.thrust_n};
  aircraft.place(level_pose(trim.angle_of_attack_rad + 0.1, 50), {12.27, 0, 0}, Vector3d::Zero(), held);
  for (int i = 0; i < 3 * physics_rate_hz; ++i) aircraft.step(held);
  EXPECT_NEAR(attack_of(aircraft.truth()), trim.angle_of_attack_rad, 0.02);
}

TEST_F(FlyingAircraft, ControlsActOneInputDelayLater) {
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  aircraft.place(level_pose(0.19, 50), {12, 0, 0}, Vector3d::Zero(), {});
  int steps_until_up = 0;
  while (aircraft.truth().left_elevon_rad == 0 && steps_until_up < 100) {
    aircraft.step({9.0, -9.0, 99.0});
    ++steps_until_up;
  }
  EXPECT_EQ(steps_until_up, 1 + 24);  // 20 ms at 1200 Hz, then the step they act in
  EXPECT_EQ(aircraft.truth().left_elevon_rad, airframe.elevon_max_rad);  // cut to the limits
  EXPECT_EQ(aircraft.truth().right_elevon_rad, airframe.elevon_min_rad);
  EXPECT_EQ(aircraft.truth().thrust_n, airframe.max_thrust_n);
  const int joint = mj_name2id(world.model.get(), mjOBJ_JOINT, "left_elevon");
  EXPECT_EQ(aircraft.data().qpos[world.model->jnt_qposadr[joint]], airframe.elevon_max_rad);
}

TEST_F(FlyingAircraft, LeftElevonUpRollsLeftInTheWorld) {
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  const Controls left{0.4, 0.0, 5.0};
  aircraft.place(level_pose(0.19, 50), {12.27, 0, 0}, Vector3d::Zero(), left);
  for (int i = 0; i < physics_rate_hz; ++i) aircraft.step(left);
  EXPECT_GT(aircraft.truth().velocity_world_mps.y(), 1.0);  // y is to the left
}

TEST_F(FlyingAircraft, CatapultReleasesAtItsSpeedAndPlace) {
  const LaunchConfig launch;
  Aircraft aircraft(*world.model, airframe, launch, Vector3d::Zero());
  EXPECT_NEAR(aircraft.truth().specific_force_body_mps2.norm(), 9.81, 1e-9);  // at rest
  const Eigen::Matrix3d attitude = aircraft.truth().T_world_body.linear();
  Vector3d pushed = Vector3d::Zero();
  while (!aircraft.launched()) {
    pushed = aircraft.truth().specific_force_body_mps2;
    aircraft.step({});
    ASSERT_LT(aircraft.truth().t_ns, 2'000'000'000);
  }
  EXPECT_NEAR(static_cast<double>(aircraft.truth().t_ns) * 1e-9, 0.25 + 2 * 1.5 / 12.0, 0.001);
  EXPECT_LT((aircraft.truth().T_world_body.translation() - Vector3d(0, 0, 1.5)).norm(), 1e-9);
  EXPECT_NEAR(aircraft.truth().velocity_world_mps.norm(), 12.0, 1e-9);
  EXPECT_NEAR(aircraft.truth().velocity_world_mps.z(), 12 * std::sin(launch.climb_angle_rad), 1e-9);
  EXPECT_TRUE(aircraft.truth().T_world_body.linear().isApprox(attitude));
  const Vector3d felt_world = attitude * pushed;
  EXPECT_NEAR(felt_world.x(), 48 * std::cos(launch.climb_angle_rad), 0.3);
  EXPECT_NEAR(felt_world.z(), 9.81 + 48 * std::sin(launch.climb_angle_rad), 0.3);
}

TEST_F(FlyingAircraft, ReleaseIsSmooth) {
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  const Trim trim = straight_trim(airframe, 12.0).value();
  const Controls full{trim.elevon_rad, trim.elevon_rad, airframe.max_thrust_n};
  while (!aircraft.launched()) aircraft.step(full);
  for (int i = 0; i < physics_rate_hz / 2; ++i) {
    aircraft.step(full);
    ASSERT_NEAR(attack_of(aircraft.truth()), trim.angle_of_attack_rad, 0.03);
    ASSERT_LT(aircraft.truth().angular_rate_body_radps.norm(), 0.5);
  }
  EXPECT_GT(aircraft.truth().T_world_body.translation().z(), 2.0);
  EXPECT_EQ(aircraft.contact(), Contact::none);
}

TEST_F(FlyingAircraft, WindMovesItOverGround) {
  const Trim trim = straight_trim(airframe, 12.27).value();
  const Vector3d wind(-3, 0, 0);
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, wind);
  const Controls held{trim.elevon_rad, trim.elevon_rad, trim.thrust_n};
  aircraft.place(level_pose(trim.angle_of_attack_rad, 50), Vector3d(12.27, 0, 0) + wind, Vector3d::Zero(),
                 held);
  for (int i = 0; i < 2 * physics_rate_hz; ++i) aircraft.step(held);
  EXPECT_NEAR(aircraft.truth().T_world_body.translation().x(), 2 * (12.27 - 3), 0.1);
}

TEST_F(FlyingAircraft, SpecificForceIntegratesToTheVelocity) {
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  Vector3d velocity_world = Vector3d::Zero();
  const auto gained = [](const Truth& truth) {
    return Vector3d((truth.T_world_body.linear() * truth.specific_force_body_mps2 + Vector3d(0, 0, -9.81)) /
                    physics_rate_hz);
  };
  int flown = 0;
  for (int i = 0; i < 2 * physics_rate_hz; ++i) {
    const Truth before = aircraft.truth();
    if (aircraft.launched()) ++flown;
    aircraft.step({0.25, 0.15, 5.0});
    // On the rail a sample is the acceleration up to it; in flight it is the air's force of its moment, which
    // moves the step that follows. The sample at the release is still the rail's.
    if (flown == 0)
      velocity_world += gained(aircraft.truth());
    else if (flown == 1)
      velocity_world = aircraft.truth().velocity_world_mps;
    else
      velocity_world += gained(before);
    if (flown == 0) {
      EXPECT_LT((velocity_world - aircraft.truth().velocity_world_mps).norm(), 1e-6);
    }
  }
  EXPECT_GT(flown, physics_rate_hz);
  EXPECT_LT((velocity_world - aircraft.truth().velocity_world_mps).norm(), 1e-6);
}

TEST(Aircraft, SameInputsSameBits) {
  const auto fly = [] {
    const Airframe airframe;
    const World world = empty_world(airframe);
    Aircraft aircraft(*world.model, airframe, LaunchConfig{}, {1, 2, 0});
    for (int i = 0; i < 3 * physics_rate_hz; ++i) {
      aircraft.step({0.2 + 0.3 * std::sin(0.01 * i), 0.2 - 0.3 * std::sin(0.01 * i), 5});
    }
    return std::vector<mjtNum>(aircraft.data().qpos, aircraft.data().qpos + 7);
  };
  EXPECT_EQ(fly(), fly());
}

TEST_F(FlyingAircraft, RefusesWhatCannotBe) {
  LaunchConfig buried;
  buried.altitude_m = 0.3;
  buried.rail_length_m = 10;
  EXPECT_THROW(Aircraft(*world.model, airframe, buried, Vector3d::Zero()), std::runtime_error);
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  EXPECT_THROW(aircraft.step({std::nan(""), 0, 0}), SimulationError);
}

/// Every number of an airframe, by the visitor that knows them all.
struct Numbers : FieldVisitor {
  void numbers(std::string_view, FieldNumbers& numbers, std::string_view) override {
    values.insert(values.end(), numbers.values.begin(), numbers.values.end());
  }
  std::vector<double> values;
};

std::vector<double> numbers_of(Airframe airframe) {
  Numbers numbers;
  visit_fields(numbers, airframe);
  return numbers.values;
}

TEST(ModelMismatch, NoneIsTheSameToTheBit) {
  EXPECT_EQ(numbers_of(mismatched(Airframe{}, {})), numbers_of(Airframe{}));
}

TEST(ModelMismatch, EachPercentageMovesWhatItSaysAndNothingElse) {
  const Airframe nominal;
  Airframe expected = nominal;
  expected.mass_kg = 0.648412 * 1.1;
  expected.inertia_kgm2 = 1.1 * nominal.inertia_kgm2;
  EXPECT_EQ(numbers_of(mismatched(nominal, {10, 0, 0, 0, 0})), numbers_of(expected));
  expected = nominal;
  expected.wing_lift_factor = 0.75;
  expected.elevon_lift_factor = 1.3 * 0.75;
  EXPECT_EQ(numbers_of(mismatched(nominal, {0, -25, 0, 0, 0})), numbers_of(expected));
  expected = nominal;
  expected.wing_drag_factor = 1.5;
  expected.elevon_drag_factor = 0.101 * 1.5;
  expected.body_drag_area_m2 = 0.0443 * 1.5;
  EXPECT_EQ(numbers_of(mismatched(nominal, {0, 0, 50, 0, 0})), numbers_of(expected));
  expected = nominal;
  expected.rate_damping_nmspr = 0.5 * nominal.rate_damping_nmspr;
  EXPECT_EQ(numbers_of(mismatched(nominal, {0, 0, 0, -50, 0})), numbers_of(expected));
  expected = nominal;
  expected.input_delay_s = 0.040;
  EXPECT_EQ(numbers_of(mismatched(nominal, {0, 0, 0, 0, 100})), numbers_of(expected));
}

// A body of mass m feels F / m: MuJoCo's body must be the heavier one, not only the forces.
TEST(ModelMismatch, TheSimulatedBodyIsTheHeavierOne) {
  const Airframe heavy = mismatched(Airframe{}, {25, 0, 0, 0, 0});
  const World world = build_world(UNDERSTORY_SOURCE_DIR "/models", heavy, {}, WorldConfig{});
  Aircraft aircraft(*world.model, heavy, LaunchConfig{}, Vector3d::Zero());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 50;
  aircraft.place(pose, Vector3d::Zero(), Vector3d::Zero(), {0, 0, 4});
  aircraft.step({0, 0, 4});
  EXPECT_NEAR(aircraft.truth().specific_force_body_mps2.x(), 4 / (0.648412 * 1.25), 1e-6);
}

// Trim scales: the same weight over more lift needs less angle of attack; twice the mass twice the lift.
TEST(ModelMismatch, TrimFollows) {
  const double nominal = straight_trim(Airframe{}, 11).value().angle_of_attack_rad;
  EXPECT_LT(straight_trim(mismatched(Airframe{}, {0, 15, 0, 0, 0}), 11).value().angle_of_attack_rad, nominal);
  // Mass, lift and drag all a tenth more, thrust too: the same flight in heavier units.
  Airframe stronger;
  stronger.max_thrust_n *= 1.1;
  stronger.winglet_area_m2 *= 1.1;
  const Trim same = straight_trim(mismatched(stronger, {10, 10, 10, 0, 0}), 11).value();
  EXPECT_NEAR(same.angle_of_attack_rad, nominal, 1e-9);
}

}  // namespace
}  // namespace understory
