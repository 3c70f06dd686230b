#include "sim/aircraft/aircraft_config.hpp"

#include <gtest/gtest.h>

#include "sim/aircraft/aerodynamics.hpp"
#include "sim/aircraft/aircraft.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

/// Every number of an airframe, by the visitor that knows them all.
struct Numbers {
  std::vector<double> values;
  void operator()(std::string_view, double& field, double, double) { values.push_back(field); }
  void operator()(std::string_view, Vector3d& field, double, double) {
    values.insert(values.end(), field.begin(), field.end());
  }
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
