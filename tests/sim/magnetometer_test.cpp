#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/sim/sensor_statistics.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

TEST(Magnetometer, FieldPointsNorthAndDown) {
  MagnetometerConfig exact;
  exact.noise_ut = exact.hard_iron_ut = exact.step_ut = 0;
  Magnetometer magnetometer(exact, 1);
  Truth truth = cruising();
  const Vector3d level = magnetometer.measure(truth).field_body_ut;
  EXPECT_NEAR(level.norm(), 48, 1e-9);
  EXPECT_NEAR(level.x(), 0, 1e-9);
  EXPECT_NEAR(level.y(), 48 * std::cos(67 * 3.14159265 / 180), 1e-3);  // flying east: north is to the left
  EXPECT_LT(level.z(), -40);
  truth.T_world_body.linear() = Eigen::AngleAxisd(3.14159265 / 2, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_NEAR(magnetometer.measure(truth).field_body_ut.x(), level.y(), 1e-6);  // flying north
}

TEST(Magnetometer, NoiseAndHardIron) {
  Magnetometer magnetometer(MagnetometerConfig{}, 2);
  const Statistics field =
      statistics(10000, [&](int) { return magnetometer.measure(cruising()).field_body_ut.x(); });
  EXPECT_NEAR(field.deviation, 0.5, 0.02);
  const Statistics iron = statistics(2000, [](int flight) {
    MagnetometerConfig quiet;
    quiet.noise_ut = quiet.step_ut = 0;
    return Magnetometer(quiet, static_cast<std::uint64_t>(flight)).measure(cruising()).field_body_ut.x();
  });
  EXPECT_NEAR(iron.deviation, 0.5, 0.05);
}

TEST(Magnetometer, SoftIronBendsTheField) {
  MagnetometerConfig config;
  config.noise_ut = config.step_ut = config.hard_iron_ut = 0;
  config.soft_iron = 0.02;
  // A row of independent entries times a field of 48 uT: 0.02 * 48 on every axis, across the field as along.
  for (int axis = 0; axis < 3; ++axis) {
    const double true_ut = Magnetometer(
                               [&] {
                                 auto exact = config;
                                 exact.soft_iron = 0;
                                 return exact;
                               }(),
                               1)
                               .measure(cruising())
                               .field_body_ut[axis];
    const Statistics bent = statistics(4000, [&](int flight) {
      return Magnetometer(config, static_cast<std::uint64_t>(flight)).measure(cruising()).field_body_ut[axis];
    });
    EXPECT_NEAR(bent.mean, true_ut, 0.08) << axis;
    EXPECT_NEAR(bent.deviation, 0.02 * 48, 0.05) << axis;
  }
  // It turns with the body: the other way round, the other sign, as no hard iron would.
  Magnetometer magnetometer(config, 5);
  Truth truth = cruising();
  truth.T_world_body.linear().setIdentity();
  const Vector3d one_way = magnetometer.measure(truth).field_body_ut;
  truth.T_world_body.linear() = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(magnetometer.measure(truth).field_body_ut.isApprox(-one_way, 1e-9));
}

}  // namespace
}  // namespace understory
