#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/sim/sensor_statistics.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

TEST(Pitot, GoodInCruisePoorWhenSlow) {
  const double density = 1.204;
  Pitot pitot(PitotConfig{}, density, 3);
  const auto spread = [&](double speed) {
    return statistics(5000, [&](int) { return pitot.measure(cruising(speed)).airspeed_mps; });
  };
  const Statistics fast = spread(12);
  EXPECT_NEAR(fast.mean, 12, 0.3);
  EXPECT_NEAR(fast.deviation, 1.5 / (density * 12), 0.02);  // dv = dp / (rho v)
  EXPECT_GT(spread(3).deviation, 0.3);                      // a tenth of the reading
  const Statistics at_rest = statistics(2000, [&](int flight) {
    return Pitot(PitotConfig{}, density, static_cast<std::uint64_t>(flight))
        .measure(cruising(0))
        .airspeed_mps;
  });
  EXPECT_GT(at_rest.mean, 0.5);  // reads a wind that is not there
}

TEST(Pitot, MeasuresAlongTheBodyAndAgainstTheWind) {
  PitotConfig exact;
  exact.pressure_noise_pa = exact.pressure_bias_pa = exact.pressure_step_pa = 0;
  Pitot pitot(exact, 1.204, 3);
  Truth truth = cruising(12);
  truth.wind_world_mps = Vector3d(-3, 0, 0);
  EXPECT_NEAR(pitot.measure(truth).airspeed_mps, 15, 1e-9);
  truth.wind_world_mps.setZero();
  truth.T_world_body.linear() = Eigen::AngleAxisd(-0.2, Vector3d::UnitY()).toRotationMatrix();
  EXPECT_NEAR(pitot.measure(truth).airspeed_mps, 12 * std::cos(0.2), 1e-9);
  EXPECT_EQ(pitot.measure(cruising(-5)).airspeed_mps, 0);
  exact.bias_mps = 3;
  EXPECT_NEAR(Pitot(exact, 1.204, 3).measure(cruising(12)).airspeed_mps, 15, 1e-9);
}

TEST(Pitot, LosesPressureOnlyBeyondTheRecoveryAngle) {
  PitotConfig config;
  config.pressure_noise_pa = config.pressure_bias_pa = config.pressure_step_pa = 0;
  config.recovery_angle_rad = 0.26;
  config.recovery_loss = 2;
  Pitot pitot(config, 1.204, 3);
  const auto turned_by = [&](double angle_rad, const Vector3d& about) {
    Truth truth = cruising(12);
    truth.T_world_body.linear() = Eigen::AngleAxisd(angle_rad, about).toRotationMatrix();
    return pitot.measure(truth).airspeed_mps;
  };
  EXPECT_NEAR(turned_by(0.25, Vector3d::UnitY()), 12 * std::cos(0.25), 1e-9);
  const double lossy = 12 * std::cos(0.46) * std::sqrt(1 - 2 * 0.2 * 0.2);
  EXPECT_NEAR(turned_by(-0.46, Vector3d::UnitY()), lossy, 1e-9);
  EXPECT_NEAR(turned_by(0.46, Vector3d::UnitZ()), lossy, 1e-9);  // sideslip as well
  EXPECT_EQ(turned_by(1.5, Vector3d::UnitY()), 0);
}

TEST(Pitot, SmallPressuresReadZeroInTheDeadZone) {
  PitotConfig config;
  config.pressure_noise_pa = config.pressure_bias_pa = config.pressure_step_pa = 0;
  config.dead_zone_pa = 4;  // 2.58 m/s
  Pitot pitot(config, 1.204, 3);
  EXPECT_EQ(pitot.measure(cruising(2.57)).airspeed_mps, 0);
  EXPECT_NEAR(pitot.measure(cruising(2.59)).airspeed_mps, 2.59, 1e-9);
}

}  // namespace
}  // namespace understory
