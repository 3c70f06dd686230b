#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/flight_mechanics.hpp"
#include "tests/validation/free_flight.hpp"

/// What the flight model's page is computed with, against closed forms and the simulator.
namespace understory {
namespace {

using Eigen::Vector3d;
constexpr double degree = std::numbers::pi / 180;

SteadyFlight level(double speed_mps, double bank_rad = 0) {
  SteadyFlight flight;
  flight.airspeed_mps = speed_mps;
  flight.bank_rad = bank_rad;
  return flight;
}

TEST(SteadyFlight, StraightAndLevelIsTheTrim) {
  const Airframe airframe;
  for (const double speed : {8.5, 10.0, 12.27}) {
    const std::optional<SteadyFlight> flight = steady_flight(airframe, level(speed), Solved::thrust);
    const std::optional<Trim> trim = straight_trim(airframe, speed);
    ASSERT_TRUE(flight && trim);
    EXPECT_NEAR(flight->angle_of_attack_rad, trim->angle_of_attack_rad, 1e-8);
    EXPECT_NEAR(flight->left_elevon_rad, trim->elevon_rad, 1e-8);
    EXPECT_NEAR(flight->right_elevon_rad, trim->elevon_rad, 1e-8);
    EXPECT_NEAR(flight->thrust_n, trim->thrust_n, 1e-7);
    EXPECT_NEAR(flight->sideslip_rad, 0, 1e-10);
    EXPECT_NEAR(flight->load_factor, 1, 1e-8);
  }
}

/// A level turn whose lift alone carries the weight: n = 1 / cos(bank), r = v^2 / (g tan(bank)). The
/// winglets' side force in the turn's small sideslip takes a share of both.
TEST(SteadyFlight, LevelTurnsAreNearlyCoordinated) {
  const Airframe airframe;
  for (const double bank_deg : {-50.0, 15.0, 30.0, 45.0, 60.0}) {
    const double bank = bank_deg * degree, speed = 12.3;
    const std::optional<SteadyFlight> turn = steady_flight(airframe, level(speed, bank), Solved::thrust);
    ASSERT_TRUE(turn) << bank_deg;
    EXPECT_NEAR(turn->load_factor * std::cos(bank), 1, 0.01) << bank_deg;
    const double radius = speed * speed / (airframe.gravity_mps2 * std::abs(std::tan(bank)));
    EXPECT_NEAR(turn->radius_m() / radius, 1, 0.015) << bank_deg;
    EXPECT_GT(turn->turn_rate_radps * bank, 0) << bank_deg;  // right wing down turns right
    EXPECT_LT(std::abs(turn->sideslip_rad), 2 * degree) << bank_deg;
  }
}

TEST(SteadyFlight, LeftTurnsMirrorRightTurns) {
  const Airframe airframe;
  const std::optional<SteadyFlight> right = steady_flight(airframe, level(11, 0.6), Solved::thrust),
                                    left = steady_flight(airframe, level(11, -0.6), Solved::thrust);
  ASSERT_TRUE(right && left);
  EXPECT_NEAR(right->left_elevon_rad, left->right_elevon_rad, 1e-8);
  EXPECT_NEAR(right->sideslip_rad, -left->sideslip_rad, 1e-8);
  EXPECT_NEAR(right->turn_rate_radps, -left->turn_rate_radps, 1e-8);
}

/// Power: along a steady glide, weight times sink is what the air takes.
TEST(SteadyFlight, GlideSpendsItsHeight) {
  Airframe airframe;
  SteadyFlight given = level(10);
  given.climb_angle_rad = -0.5;
  const std::optional<SteadyFlight> glide = steady_flight(airframe, given, Solved::climb_angle);
  ASSERT_TRUE(glide);
  const AirState air = glide->air();
  const double taken_w = -aerodynamic_wrench(airframe, air).force_body_n.dot(air.air_velocity_body_mps);
  EXPECT_NEAR(airframe.mass_kg * airframe.gravity_mps2 * glide->sink_mps(), taken_w, 1e-6);
}

TEST(SteadyFlight, NothingBeyondTheCapOfTheAngleOfAttack) {
  EXPECT_FALSE(steady_flight(Airframe{}, level(9, 60 * degree), Solved::thrust));
}

/// Six equations of our own against one step of MuJoCo's, in wild attitudes.
TEST(Modes, EquationsAreTheSimulators) {
  const Airframe airframe;
  const FreeFlight air(airframe);
  std::mt19937_64 generator(4);
  const auto uniform = [&](double minimum, double maximum) {
    return std::uniform_real_distribution<double>(minimum, maximum)(generator);
  };
  for (int trial = 0; trial < 50; ++trial) {
    BodyMotion motion;
    motion << uniform(8, 14), uniform(-2, 2), uniform(-4, 0), uniform(-4, 4), uniform(-2, 2), uniform(-2, 2),
        uniform(-1.2, 1.2), uniform(-0.6, 0.6);
    AirborneStart start;
    start.R_world_body =
        (Eigen::AngleAxisd(uniform(-3, 3), Vector3d::UnitZ()) *
         Eigen::AngleAxisd(motion[7], Vector3d::UnitY()) * Eigen::AngleAxisd(motion[6], Vector3d::UnitX()))
            .toRotationMatrix();
    start.velocity_body_mps = motion.head<3>();
    start.angular_rate_body_radps = motion.segment<3>(3);
    start.controls = {uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(0, 5)};
    AirState surfaces;
    surfaces.left_elevon_rad = start.controls.left_elevon_rad;
    surfaces.right_elevon_rad = start.controls.right_elevon_rad;
    surfaces.thrust_n = start.controls.thrust_n;
    const BodyMotion change = rate_of_change(airframe, motion, surfaces);
    Aircraft aircraft = air.begin(airframe, start);
    const Truth before = aircraft.truth();
    aircraft.step(start.controls);
    const Truth& after = aircraft.truth();
    const Vector3d acceleration_body = start.R_world_body.transpose() *
                                       (after.velocity_world_mps - before.velocity_world_mps) *
                                       physics_rate_hz;
    const Vector3d turning = start.angular_rate_body_radps.cross(start.velocity_body_mps);
    EXPECT_LT((acceleration_body - (change.head<3>() + turning)).norm(), 1e-5);
    const Vector3d angular =
        (after.angular_rate_body_radps - before.angular_rate_body_radps) * physics_rate_hz;
    EXPECT_LT((angular - change.segment<3>(3)).norm(), 1e-3 * (1 + change.segment<3>(3).norm()));
    const auto roll = [](const Truth& truth) {
      return std::atan2(truth.T_world_body.linear()(2, 1), truth.T_world_body.linear()(2, 2));
    };
    EXPECT_NEAR((roll(after) - roll(before)) * physics_rate_hz, change[6], 0.1);  // half a step's curvature
  }
}

/// With neither elevons nor winglets only the identified damping answers a roll: exp(-D t / I).
TEST(Modes, RollSubsidenceIsDampingOverInertia) {
  Airframe airframe;
  airframe.elevon_area_m2 = airframe.winglet_area_m2 = 0;
  SteadyFlight flight = level(12);
  flight.angle_of_attack_rad = 0.1;
  flight.thrust_n = 4;
  const Modes found = modes(airframe, flight);
  EXPECT_EQ(found.lateral.front().name, "roll subsidence");
  EXPECT_NEAR(found.lateral.front().eigenvalue.real(),
              -airframe.rate_damping_nmspr.x() / airframe.inertia_kgm2.x(), 1e-6);
  EXPECT_NEAR(found.lateral.front().time_constant_s(), 0.01526 / 0.074, 1e-6);
}

/// Lanchester 1908: where the angle of attack holds itself and nothing drags, speed and height swing with
/// sqrt(2) g / v.
TEST(Modes, PhugoidIsLanchesters) {
  Airframe airframe;
  airframe.body_drag_area_m2 = 0;
  airframe.elevon_drag_factor = 0;
  airframe.wing_area_m2 *= 10;  // a small angle of attack: the drag is next to nothing
  airframe.rate_damping_nmspr.setZero();
  // A light nose that elevons close behind hold into the wind at once; farther behind they would pitch it by
  // the turning of the path itself.
  airframe.inertia_kgm2.y() = 1e-6;
  airframe.elevon_hinge_x_m = -0.005;
  airframe.elevon_chord_m = 0.001;
  const double speed = 12;
  const std::optional<SteadyFlight> trim = steady_flight(airframe, level(speed), Solved::thrust);
  ASSERT_TRUE(trim);
  const Modes found = modes(airframe, *trim);
  const Mode& phugoid = found.longitudinal.back();
  EXPECT_EQ(phugoid.name, "phugoid");
  ASSERT_TRUE(phugoid.swings());
  EXPECT_NEAR(phugoid.frequency_radps(), std::numbers::sqrt2 * airframe.gravity_mps2 / speed, 0.05);
  EXPECT_LT(phugoid.damping(), 0.1);
}

TEST(Modes, OfTheAircraftAreFiveAndNamed) {
  const std::optional<SteadyFlight> trim = steady_flight(Airframe{}, level(12), Solved::thrust);
  ASSERT_TRUE(trim);
  const Modes found = modes(Airframe{}, *trim);
  ASSERT_EQ(found.longitudinal.size(), 2u);
  ASSERT_EQ(found.lateral.size(), 3u);
  EXPECT_LT(found.coupling, 1e-9);  // a symmetric aircraft in straight flight
  std::vector<std::string> names;
  for (const Mode& mode : found.lateral) names.push_back(mode.name);
  EXPECT_EQ(names, (std::vector<std::string>{"roll subsidence", "dutch roll", "spiral"}));
}

}  // namespace
}  // namespace understory
