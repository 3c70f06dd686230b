#include "sim/aircraft/wind.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "sim/scene/world.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;
constexpr double step_s = 1.0 / 1200;

/// Flies level and straight along world x through `wind`, at `airspeed_mps` relative to the mean wind.
struct Passage {
  Wind wind;
  Vector3d mean_world_mps;
  double altitude_m;
  double airspeed_mps = 12;
  std::int64_t step = 0;

  Vector3d next() {
    ++step;
    const Vector3d position(0, 0, altitude_m);
    wind.advance(time_of_step_ns(step), step_s, position, mean_world_mps + Vector3d(airspeed_mps, 0, 0));
    return wind.at(position);
  }
};

TEST(Wind, SteadyByDefaultToTheBit) {
  const Vector3d mean(1.25, -2.5, 0.3);
  Passage passage{Wind(mean, {}, {}, 5), mean, 2};
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(passage.next(), mean);
}

// The profile's own properties: the mean at the reference height, a slope of u / (h ln(h_ref / z_0)), zero
// where it is said to end.
TEST(Wind, ShearIsLogarithmic) {
  WindConfig config;
  config.roughness_m = 0.0457;
  const Vector3d mean(0, 3, 0);
  const Wind wind(mean, config, {}, 0);
  EXPECT_LT((wind.at({0, 0, 6.096}) - mean).norm(), 1e-12);
  EXPECT_NEAR(wind.at({0, 0, 3.048}).y(), 3 * (1 - std::log(2.0) / std::log(6.096 / 0.0457)), 1e-12);
  EXPECT_NEAR(wind.at({0, 0, 12.192}).y() - 3, 3 - wind.at({0, 0, 3.048}).y(), 1e-12);  // even in ln h
  EXPECT_EQ(wind.at({0, 0, 0}), wind.at({0, 0, 0.9}));  // below 3 ft as at 3 ft
  config.roughness_m = 2;
  EXPECT_EQ(Wind(mean, config, {}, 0).at({0, 0, 1}), Vector3d::Zero());
}

// MIL-F-8785C: half of it at half the length, all of it from the length on; the maximum slope is pi / 2
// amplitude / length at the middle.
TEST(Wind, GustIsOneMinusCosineOfTheWayFlown) {
  WindConfig config;
  config.gust = {2, 6, {0, 1, -4}};
  const Vector3d mean(0, 3, 0);
  Passage passage{Wind(mean, config, {}, 0), mean, 3};
  Vector3d before = mean;
  while (passage.step < 2 * 1200) ASSERT_EQ(before = passage.next(), mean);
  double steepest = 0;
  for (int i = 1; i <= 600; ++i) {  // 10 mm a step: 6 m in 600 steps
    const Vector3d now = passage.next();
    const double x_m = 12 * step_s * i;
    ASSERT_LT((now - mean - 0.5 * (1 - std::cos(std::numbers::pi * x_m / 6)) * Vector3d(0, 1, -4)).norm(),
              1e-9);
    steepest = std::max(steepest, (now - before).norm() / (12 * step_s));
    before = now;
  }
  EXPECT_NEAR(steepest, std::numbers::pi / 2 * std::sqrt(17.0) / 6, 1e-4);
  EXPECT_LT((before - mean - Vector3d(0, 1, -4)).norm(), 1e-9);
  EXPECT_LT((passage.next() - mean - Vector3d(0, 1, -4)).norm(), 1e-9);  // and stays
}

TEST(Wind, ForestSheltersBelowItsCrowns) {
  WindConfig config;
  config.shelter_factor = 0.2;
  config.shelter_edge_m = 10;
  const Vector3d mean(0, 5, 0);
  const Wind wind(mean, config, {15, 75, 25, 9}, 0);
  EXPECT_EQ(wind.at({10, 0, 3}), mean);                         // before the forest
  EXPECT_LT((wind.at({45, 0, 3}) - 0.2 * mean).norm(), 1e-12);  // deep in it
  EXPECT_EQ(wind.at({45, 0, 9.5}), mean);                       // above it
  EXPECT_EQ(wind.at({45, 30, 3}), mean);                        // beside it
  EXPECT_LT((wind.at({20, 0, 3}) - 0.6 * mean).norm(), 1e-12);  // half way through the edge
  EXPECT_LT((wind.at({72.5, 0, 3}) - 0.8 * mean).norm(), 1e-12);
}

// The world's components are the Dryden components turned by the mean wind's direction: along 1.93 sigma_w
// (20 ft), across as much, up sigma_w = 0.1 W20, at the flight's own 1200 Hz. Sigma of a mean square over a
// way s is sqrt(2 L / s): 6000 s of 12 m/s are 72 km, so 3.5 % along, 1.3 % up.
TEST(Wind, TurbulenceHasItsVarianceInTheMeanWindsAxes) {
  WindConfig config;
  config.turbulence_wind20_mps = 3;
  const Vector3d mean(-2, 2, 0);
  Passage passage{Wind(mean, config, {}, 9), mean, 6.096};
  const Vector3d along = mean.normalized(), up = Vector3d::UnitZ(), across = up.cross(along);
  Vector3d squares = Vector3d::Zero();
  double both = 0;
  constexpr int count = 6000 * 1200;
  for (int i = 0; i < count; ++i) {
    const Vector3d gust = passage.next() - mean;
    const Vector3d parts(gust.dot(along), gust.dot(across), gust.dot(up));
    squares += parts.cwiseAbs2();
    both += parts.x() * parts.y();
  }
  const DrydenScales scales = low_altitude_dryden(6.096, 3);
  EXPECT_NEAR(squares.x() / count / std::pow(scales.sigma_mps.x(), 2), 1, 0.14);
  EXPECT_NEAR(squares.y() / count / std::pow(scales.sigma_mps.y(), 2), 1, 0.14);
  EXPECT_NEAR(squares.z() / count / std::pow(scales.sigma_mps.z(), 2), 1, 0.05);
  EXPECT_NEAR(both / count / std::pow(scales.sigma_mps.x(), 2), 0, 0.14);
}

TEST(Wind, SameSeedSameAir) {
  WindConfig config;
  config.turbulence_wind20_mps = 3;
  const auto air = [&](std::uint64_t seed) {
    Passage passage{Wind(Vector3d(0, 3, 0), config, {}, seed), {0, 3, 0}, 4};
    Vector3d last;
    for (int i = 0; i < 1200; ++i) last = passage.next();
    return last;
  };
  EXPECT_EQ(air(1), air(1));
  EXPECT_NE(air(1), air(2));
}

}  // namespace
}  // namespace understory
