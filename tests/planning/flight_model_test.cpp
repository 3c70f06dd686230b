#include "planning/flight_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/planning/forests.hpp"

namespace understory {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double step_s = 0.02;

FlightModel model_at(double cruise_speed_mps) {
  return FlightModel(Airframe{}, {.cruise_speed_mps = cruise_speed_mps});
}

FlightState fly_for(const FlightModel& model, FlightState state, const FlightCommand& command,
                    double seconds) {
  for (int i = 0; i < std::lround(seconds / step_s); ++i) state = model.advance(state, command, step_s);
  return state;
}

// The identified aircraft's level trim: 12.27 m/s at 10.97 deg and 5.08 N (flight records).
TEST(FlightModel, LevelTrimHoldsSpeedHeightAndHeading) {
  const FlightModel model = model_at(12.27);
  FlightState start;
  start.speed_mps = 12.27;
  start.angle_of_attack_rad = 0.1914;
  EXPECT_NEAR(model.commanded_thrust_n(start), 5.08, 0.3);
  EXPECT_NEAR(model.commanded_angle_of_attack_rad(start, 0), 0.1914, 0.02);
  const FlightState end = fly_for(model, start, {}, 4);
  EXPECT_NEAR(end.speed_mps, 12.27, 0.3);
  EXPECT_NEAR(end.position_world.z(), 0, 0.25);
  EXPECT_NEAR(end.heading_rad, 0, 1e-9);
  EXPECT_NEAR(end.position_world.y(), 0, 1e-9);
  EXPECT_NEAR(end.position_world.x(), 4 * 12.27, 1.0);
}

TEST(FlightModel, BankTurnsTowardsTheLowWing) {
  const FlightModel model = model_at(12);
  const FlightState right = fly_for(model, {}, {0.7, 0}, 1);
  EXPECT_LT(right.heading_rad, -0.2);
  EXPECT_LT(right.position_world.y(), -0.5);
  const FlightState left = fly_for(model, {}, {-0.7, 0}, 1);  // the mirror image, exactly
  EXPECT_NEAR(left.heading_rad, -right.heading_rad, 1e-9);
  EXPECT_NEAR(left.position_world.y(), -right.position_world.y(), 1e-9);
  EXPECT_NEAR(left.position_world.x(), right.position_world.x(), 1e-9);
}

// Lift and drag of a plate k times as strong are those of a plate k times as large.
TEST(FlightModel, WingFactorsAreASizeOfWing) {
  Airframe stronger, larger;
  stronger.wing_lift_factor = stronger.wing_drag_factor = 1.25;
  larger.wing_area_m2 *= 1.25;
  const FlightState strong = fly_for(FlightModel(stronger, {}), {}, {0.7, 1}, 1);
  const FlightState large = fly_for(FlightModel(larger, {}), {}, {0.7, 1}, 1);
  EXPECT_LT((strong.position_world - large.position_world).norm(), 1e-9);
  EXPECT_NEAR(strong.speed_mps, large.speed_mps, 1e-9);
}

// The plate's drag is 2 sin^2 a per dynamic pressure and area: the factor's share of it is lost speed.
TEST(FlightModel, MoreWingDragIsLostSpeed) {
  Airframe draggy;
  draggy.wing_drag_factor = 1.5;
  draggy.max_thrust_n = 0;  // no throttle to make up for it
  Airframe plain = draggy;
  plain.wing_drag_factor = 1;
  const FlightState start;
  const double drag_n = 0.5 * 2 * std::pow(std::sin(start.angle_of_attack_rad), 2) * 0.5 * 1.204 *
                        start.speed_mps * start.speed_mps * 0.1811;
  const double lost_mps = FlightModel(plain, {}).advance(start, {}, step_s).speed_mps -
                          FlightModel(draggy, {}).advance(start, {}, step_s).speed_mps;
  EXPECT_NEAR(lost_mps, step_s * drag_n / 0.648412, 1e-9);
}

// Coordinated level turn: tan(bank) = V^2 / (g r).
TEST(FlightModel, SustainedTurnHasTheRadiusOfACoordinatedOne) {
  const FlightModel model = model_at(12);
  for (const double bank : {0.35, 0.6, 0.8}) {
    FlightState state = fly_for(model, {}, {bank, 0}, 2);
    const double heading = state.heading_rad;
    double path_m = 0;
    for (int i = 0; i < 100; ++i) {
      const Vector3d before = state.position_world;
      state = model.advance(state, {bank, 0}, step_s);
      path_m += (state.position_world - before).norm();
    }
    const double radius_m = path_m / (heading - state.heading_rad);
    const double speed = path_m / (100 * step_s);
    const double closed_form_m = speed * speed / (9.81 * std::tan(state.bank_rad));
    EXPECT_NEAR(radius_m, closed_form_m, 0.12 * closed_form_m) << "bank " << bank;
    EXPECT_NEAR(state.bank_rad, bank, 0.05);
  }
}

TEST(FlightModel, HardTurnsCostSpeed) {
  const FlightModel model = model_at(12);
  const double level = fly_for(model, {}, {0, 0}, 1).speed_mps;
  const double gentle = fly_for(model, {}, {0.5, 0}, 1).speed_mps;
  const double hard = fly_for(model, {}, {1.3, 0}, 1).speed_mps;
  EXPECT_LT(gentle, level);
  EXPECT_LT(hard, gentle - 0.3);
}

TEST(FlightModel, StaysInsideItsEnvelopeUnderAnyCommands) {
  std::mt19937_64 generator(7);
  const auto uniform = [&](double minimum, double maximum) {
    return std::uniform_real_distribution<double>(minimum, maximum)(generator);
  };
  for (int flight = 0; flight < 200; ++flight) {
    const FlightModel model = model_at(uniform(10, 13));
    const FlightModelConfig& config = model.config();
    FlightState state;
    state.speed_mps = uniform(9, 14);
    for (int part = 0; part < 12; ++part) {
      const FlightCommand command{uniform(-1.57, 1.57), uniform(-1.5, 2)};
      for (int i = 0; i < 15; ++i) {
        const FlightState next = model.advance(state, command, step_s);
        ASSERT_TRUE(next.position_world.allFinite());
        ASSERT_TRUE(std::isfinite(next.speed_mps + next.heading_rad + next.climb_angle_rad + next.bank_rad +
                                  next.roll_rate_radps + next.sideslip_rad + next.yaw_rate_radps));
        EXPECT_LE(next.angle_of_attack_rad, config.maximum_angle_of_attack_rad + 1e-9);
        EXPECT_GE(next.angle_of_attack_rad, config.minimum_angle_of_attack_rad - 1e-9);
        // The limit holds about the velocity, for what is asked; the lag towards it may add a little.
        const double limit =
            config.maximum_roll_rate_radps * std::max(state.speed_mps, next.speed_mps) / 12.27;
        EXPECT_LE(std::abs(next.bank_rad - state.bank_rad) / step_s, 1.1 * limit);
        EXPECT_LT(std::abs(next.sideslip_rad), 1.2);  // on edge it falls sideways, never tail first
        state = next;
      }
    }
  }
}

TEST(FlightModel, ShortAndLongStepsAgree) {
  const FlightModel model = model_at(12);
  FlightState coarse, fine;
  for (const FlightCommand& command : {FlightCommand{0.9, 0.5}, {-1.2, 0}, {0.2, -0.5}}) {
    for (int i = 0; i < 20; ++i) coarse = model.advance(coarse, command, 0.02);
    for (int i = 0; i < 160; ++i) fine = model.advance(fine, command, 0.0025);
  }
  EXPECT_LT((coarse.position_world - fine.position_world).norm(), 0.15);  // of 14 m flown
}

// Moving air is a moving frame: seen from it, the flight is that of still air.
TEST(FlightModel, WindCarriesTheFlightAlong) {
  const FlightModel model = model_at(12);
  FlightState still, carried;
  carried.wind_world_mps = {-2, 3};
  for (const FlightCommand& command : {FlightCommand{0.9, 0.5}, {-1.2, 0}})
    for (int i = 0; i < 20; ++i) {
      still = model.advance(still, command, 0.02);
      carried = model.advance(carried, command, 0.02);
    }
  EXPECT_NEAR((carried.position_world - still.position_world - 0.8 * Vector3d(-2, 3, 0)).norm(), 0, 1e-9);
  EXPECT_EQ(carried.heading_rad, still.heading_rad);
  EXPECT_EQ(carried.speed_mps, still.speed_mps);
  EXPECT_EQ(carried.sideslip_rad, still.sideslip_rad);
}

TEST(FlightState, LeftWingPointsUpOnTheRightEdge) {
  FlightState state;
  state.bank_rad = M_PI / 2;
  EXPECT_NEAR((left_wing_direction_world(state) - Vector3d::UnitZ()).norm(), 0, 1e-12);
  state.bank_rad = 0;
  state.heading_rad = M_PI / 2;  // flying along y: the left wing points back along -x
  EXPECT_NEAR((left_wing_direction_world(state) + Vector3d::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((flight_direction_world(state) - Vector3d::UnitY()).norm(), 0, 1e-12);
}

TEST(FlightState, ReadsHandMadeAttitudes) {
  // Level, nose 0.2 rad up, moving along x: the angle of attack is the pitch.
  Eigen::Isometry3d pose(AngleAxisd(-0.2, Vector3d::UnitY()));
  const FlightState level =
      flight_state(pose, pose.linear().transpose() * Vector3d(12, 0, 0), {0.1, 0.2, 0.3});
  EXPECT_NEAR(level.angle_of_attack_rad, 0.2, 1e-12);
  EXPECT_NEAR(level.speed_mps, 12, 1e-12);
  EXPECT_NEAR(level.heading_rad, 0, 1e-12);
  EXPECT_NEAR(level.climb_angle_rad, 0, 1e-12);
  EXPECT_NEAR(level.bank_rad, 0, 1e-12);
  EXPECT_EQ(level.roll_rate_radps, 0.1);
  EXPECT_EQ(level.yaw_rate_radps, 0.3);
  // Right wing straight down, moving along the nose.
  pose = AngleAxisd(M_PI / 2, Vector3d::UnitX());
  EXPECT_NEAR(flight_state(pose, {12, 0, 0}, Vector3d::Zero()).bank_rad, M_PI / 2, 1e-12);
  // Moving to the left of the nose is positive sideslip, and a positive heading.
  pose.setIdentity();
  const FlightState slipping = flight_state(pose, {10, 1, 0}, Vector3d::Zero());
  EXPECT_NEAR(slipping.sideslip_rad, std::atan(0.1), 1e-12);
  EXPECT_NEAR(slipping.heading_rad, std::atan(0.1), 1e-12);
}

TEST(FlightState, TellsTheWayThroughTheAirFromThatOverGround) {
  // Crabbing: along x over ground, in a wind from the right (towards y), the nose in the air's direction.
  const double crab = std::asin(3.0 / 12.0);
  State estimate;
  estimate.T_world_body = AngleAxisd(-crab, Vector3d::UnitZ());
  estimate.wind_world_mps = {0, 2};
  estimate.gust_world_mps = {0, 1};
  estimate.velocity_body_mps =
      estimate.T_world_body.linear().transpose() * Vector3d(12 * std::cos(crab), 0, 0);
  const FlightState state = flight_state(estimate);
  EXPECT_NEAR(state.speed_mps, 12, 1e-12);
  EXPECT_NEAR(state.heading_rad, -crab, 1e-12);
  EXPECT_NEAR(state.sideslip_rad, 0, 1e-12);
  EXPECT_NEAR(course_rad(state), 0, 1e-12);
  EXPECT_EQ(state.wind_world_mps, Eigen::Vector2d(0, 3));
}

TEST(FlightState, RoundTripsThroughWindAxes) {
  std::mt19937_64 generator(3);
  const auto uniform = [&](double size) {
    return std::uniform_real_distribution<double>(-size, size)(generator);
  };
  for (int i = 0; i < 1000; ++i) {
    const double heading = uniform(3.1), climb = uniform(1.2), bank = uniform(3.0), attack = uniform(0.6),
                 sideslip = uniform(0.6), speed = 10 + uniform(5);
    const Eigen::Matrix3d wind = (AngleAxisd(heading, Vector3d::UnitZ()) *
                                  AngleAxisd(-climb, Vector3d::UnitY()) * AngleAxisd(bank, Vector3d::UnitX()))
                                     .toRotationMatrix();
    const Eigen::Matrix3d body_in_wind =
        (AngleAxisd(-sideslip, Vector3d::UnitZ()) * AngleAxisd(-attack, Vector3d::UnitY()))
            .toRotationMatrix();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = wind * body_in_wind;
    const FlightState state =
        flight_state(pose, body_in_wind.transpose() * Vector3d(speed, 0, 0), Vector3d::Zero());
    EXPECT_NEAR(state.speed_mps, speed, 1e-9);
    EXPECT_NEAR(state.heading_rad, heading, 1e-9);
    EXPECT_NEAR(state.climb_angle_rad, climb, 1e-9);
    EXPECT_NEAR(state.bank_rad, bank, 1e-9);
    EXPECT_NEAR(state.angle_of_attack_rad, attack, 1e-9);
    EXPECT_NEAR(state.sideslip_rad, sideslip, 1e-9);
    EXPECT_NEAR((left_wing_direction_world(state) - left_wing_by_rotations(heading, climb, bank)).norm(), 0,
                1e-9);
  }
}

}  // namespace
}  // namespace understory
