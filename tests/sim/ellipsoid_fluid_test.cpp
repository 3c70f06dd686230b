#include "tests/sim/ellipsoid_fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace understory {
namespace {

AirState plate_flying(double speed_mps, double attack_rad) {
  AirState air;
  air.air_velocity_body_mps = speed_mps * Eigen::Vector3d(std::cos(attack_rad), 0, -std::sin(attack_rad));
  return air;
}

/// Nothing but the wing: the rest is too small to feel.
Airframe wing_alone() {
  Airframe airframe;
  airframe.elevon_area_m2 = airframe.winglet_area_m2 = 1e-8;
  return airframe;
}

TEST(EllipsoidFluid, StillAirGivesNoForce) {
  const Wrench wrench = EllipsoidFluid(Airframe{}, {}).wrench(AirState{});
  EXPECT_EQ(wrench.force_body_n, Eigen::Vector3d(Eigen::Vector3d::Zero()));
  EXPECT_EQ(wrench.moment_body_nm, Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

/// For a thin plate MuJoCo's Kutta term becomes density * area * v^2 * sin a * cos a: the flat plate's own
/// lift.
TEST(EllipsoidFluid, LiftOfAPlateIsTheFlatPlates) {
  const Airframe airframe = wing_alone();
  const EllipsoidFluid fluid(airframe, {});
  for (const double attack : {0.3, 0.6, 1.0}) {
    const Wrench wrench = fluid.wrench(plate_flying(12, attack));
    const Eigen::Vector3d up(std::sin(attack), 0, std::cos(attack));
    const double expected =
        airframe.air_density_kgpm3 * airframe.wing_area_m2 * 144 * std::sin(attack) * std::cos(attack);
    EXPECT_NEAR(wrench.force_body_n.dot(up), expected, 0.02 * expected) << attack;
  }
}

/// Square to the flow: density * area * v^2 * blunt coefficient.
TEST(EllipsoidFluid, DragSquareToTheFlowIsItsCoefficient) {
  const Airframe airframe = wing_alone();
  EllipsoidCoefficients coefficients;
  coefficients.blunt_drag = 0.7;
  const Wrench wrench = EllipsoidFluid(airframe, coefficients).wrench(plate_flying(12, 1.5707963));
  const double expected = airframe.air_density_kgpm3 * airframe.wing_area_m2 * 144 * 0.7;
  EXPECT_NEAR(wrench.force_body_n.z(), expected, 0.01 * expected);
}

TEST(EllipsoidFluid, ElevonsTurnAsTheAirframesDo) {
  const EllipsoidFluid fluid(Airframe{}, {});
  AirState air = plate_flying(12, 0.19);
  air.left_elevon_rad = air.right_elevon_rad = 0.3;
  const double symmetric = fluid.wrench(air).moment_body_nm.x();
  EXPECT_NEAR(symmetric, 0, 1e-9);
  air.right_elevon_rad = 0;  // left trailing edge up: rolls left
  EXPECT_LT(fluid.wrench(air).moment_body_nm.x(), -0.01);
}

}  // namespace
}  // namespace understory
