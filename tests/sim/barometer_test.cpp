#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/sim/sensor_statistics.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

TEST(Barometer, NoiseIsWhiteAndDriftIsSlow) {
  Barometer barometer(BarometerConfig{}, 9);
  const Statistics first_minute_seconds =
      statistics(250, [&](int i) { return barometer.measure(cruising(12, 24 * i)).altitude_m; });
  EXPECT_NEAR(first_minute_seconds.deviation, 0.3, 0.1);
  EXPECT_NEAR(first_minute_seconds.mean, 3, 0.5);

  BarometerConfig drifting;
  drifting.noise_m = drifting.step_m = 0;
  const Statistics far = statistics(3000, [&](int flight) {
    Barometer fresh(drifting, static_cast<std::uint64_t>(flight));
    fresh.measure(cruising(12, 0));
    return fresh.measure(cruising(12, 1200 * 600)).altitude_m;  // ten time constants later
  });
  EXPECT_NEAR(far.deviation, drifting.drift_m, 0.05);
  Barometer fresh(drifting, 1);
  fresh.measure(cruising(12, 0));
  EXPECT_NEAR(fresh.measure(cruising(12, 24)).altitude_m, 3, 0.1);  // 20 ms later: next to nothing
}

TEST(Barometer, ThePropellersWashReadsAsHeight) {
  BarometerConfig config;
  config.noise_m = config.step_m = config.drift_m = 0;
  config.wash_m_per_n = 0.26;
  Barometer barometer(config, 1);
  Truth truth = cruising();
  EXPECT_EQ(barometer.measure(truth).altitude_m, 3);
  truth.thrust_n = 5;
  EXPECT_NEAR(barometer.measure(truth).altitude_m, 3 + 5 * 0.26, 1e-12);
}

}  // namespace
}  // namespace understory
