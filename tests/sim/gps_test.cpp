#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/sim/sensor_statistics.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t steps_per_fix = 240;  // 5 Hz

TEST(Gps, VelocityNoiseIsWhite) {
  Gps gps(GpsConfig{}, 4);
  double previous = 0, product = 0;
  const Statistics error = statistics(20000, [&](int fix) {
    const double now = gps.measure(cruising(12, fix * steps_per_fix)).velocity_world_mps.x() - 12;
    product += now * previous / 20000;
    previous = now;
    return now;
  });
  EXPECT_NEAR(error.mean, 0, 0.006);
  EXPECT_NEAR(error.deviation, 0.2, 0.005);
  EXPECT_NEAR(product, 0, 0.002);
}

TEST(Gps, PositionErrorWandersFromTheFirstFixOn) {
  GpsConfig config;
  config.position_noise_m = 0;
  double squares = 0, product = 0, height_squares = 0;
  constexpr int flights = 4000;
  for (int flight = 0; flight < flights; ++flight) {
    Gps gps(config, static_cast<std::uint64_t>(flight));
    const Vector3d truth = cruising().T_world_body.translation();
    const Vector3d first = gps.measure(cruising()).position_world_m - truth;
    Vector3d later;
    for (int second = 1; second <= 60; ++second)  // one time constant
      later = gps.measure(cruising(12, 1200 * second)).position_world_m - truth;
    squares += first.x() * first.x() / flights;
    product += first.x() * later.x() / flights;
    height_squares += first.z() * first.z() / flights;
  }
  EXPECT_NEAR(std::sqrt(squares), 2.1, 0.1);
  EXPECT_NEAR(product / squares, std::exp(-1.0), 0.06);
  EXPECT_NEAR(std::sqrt(height_squares), 1.5 * 2.1, 0.15);
}

TEST(Gps, FixesAreNewByThePositionNoise) {
  GpsConfig config;
  config.position_drift_m = 0;
  Gps gps(config, 9);
  const Statistics error = statistics(
      5000, [&](int fix) { return gps.measure(cruising(12, fix * steps_per_fix)).position_world_m.y(); });
  EXPECT_NEAR(error.deviation, 0.3, 0.02);
}

TEST(Gps, AFixSpeaksOfItsMoment) {
  EXPECT_EQ(Gps({}, 1).measure(cruising(12, 480)).t_ns, time_of_step_ns(480));
  GpsConfig exact;
  exact.velocity_noise_mps = exact.position_noise_m = exact.position_drift_m = 0;
  const GpsSample fix = Gps(exact, 1).measure(cruising());
  EXPECT_EQ(fix.velocity_world_mps, cruising().velocity_world_mps);
  EXPECT_EQ(fix.position_world_m, cruising().T_world_body.translation());
}

}  // namespace
}  // namespace understory
