#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "scenarios/forest.hpp"
#include "scenarios/goalposts.hpp"
#include "scenarios/named_seed.hpp"

namespace understory {
namespace {

TEST(Forest, TreesStandWithinBounds) {
  const ForestConfig config;
  for (const Obstacle& tree : poisson_forest(config, 1000)) {
    EXPECT_GE(tree.from_world.x(), 15);
    EXPECT_LE(tree.from_world.x(), 75);
    EXPECT_LE(std::abs(tree.from_world.y()), 25);
    EXPECT_GE(tree.radius_m, 0.10);
    EXPECT_LE(tree.radius_m, 0.25);
    EXPECT_EQ(tree.from_world.z(), 0);
    EXPECT_GT(tree.to_world.z(), 6);
  }
}

// Poisson: mean and variance both area / density. 400 forests: the mean's standard error is sqrt(mean / 400),
// the variance's about variance * sqrt(2 / 399); four of each.
TEST(Forest, CountsArePoisson) {
  const ForestConfig config;
  const double expected = 60.0 * 50.0 / 49.0;
  const int forests = 400;
  double sum = 0;
  double sum_squared = 0;
  for (int seed = 0; seed < forests; ++seed) {
    const double count = static_cast<double>(poisson_forest(config, static_cast<std::uint64_t>(seed)).size());
    sum += count;
    sum_squared += count * count;
  }
  const double mean = sum / forests;
  const double variance = (sum_squared - forests * mean * mean) / (forests - 1);
  EXPECT_NEAR(mean, expected, 4 * std::sqrt(expected / forests));
  EXPECT_NEAR(variance, expected, 4 * expected * std::sqrt(2.0 / (forests - 1)));
}

// In a Poisson process the counts in two halves are independent and each uniform: no bias to a side or to the
// front.
TEST(Forest, TreesAreUniform) {
  const ForestConfig config;
  double left = 0;
  double front = 0;
  double all = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    for (const Obstacle& tree : poisson_forest(config, seed)) {
      all += 1;
      left += tree.from_world.y() > 0;
      front += tree.from_world.x() < 45;
    }
  }
  EXPECT_NEAR(left / all, 0.5, 4 * 0.5 / std::sqrt(all));
  EXPECT_NEAR(front / all, 0.5, 4 * 0.5 / std::sqrt(all));
}

TEST(Forest, SeedsDecide) {
  const ForestConfig config;
  const auto first = poisson_forest(config, 7);
  const auto again = poisson_forest(config, 7);
  const auto other = poisson_forest(config, 8);
  ASSERT_EQ(first.size(), again.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].from_world, again[i].from_world);
  EXPECT_NE(first.front().from_world, other.front().from_world);
}

TEST(Goalposts, ArePassedWithinTheirDistances) {
  const GoalpostsConfig config;
  int left = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto bars = goalposts(config, seed);
    ASSERT_EQ(bars.size(), 3u);
    const double near_y = bars[0].from_world.y();
    const double far_y = bars[1].from_world.y();
    EXPECT_GE(std::abs(near_y) - config.radius_m, 0.5);
    EXPECT_LE(std::abs(near_y) - config.radius_m, 2.0);
    EXPECT_LT(near_y * far_y, 0);  // the course runs between the uprights
    const double between_axes_m = (bars[0].from_world - bars[1].from_world).norm();
    EXPECT_NEAR(between_axes_m - 2 * config.radius_m, 5.639, 1e-12);  // 18 ft 6 in
    EXPECT_NEAR(bars[2].from_world.z() + bars[2].radius_m, 3.048, 1e-12);
    left += near_y > 0;
  }
  EXPECT_NEAR(left, 100, 30);
}

TEST(NamedSeed, NamesAndNeighboursAreUnrelated) {
  EXPECT_NE(seed_for(1, "forest"), seed_for(1, "camera"));
  EXPECT_NE(seed_for(1, "forest"), seed_for(2, "forest"));
  int different_bits = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    different_bits += std::popcount(seed_for(seed, "imu") ^ seed_for(seed + 1, "imu"));
  }
  EXPECT_NEAR(different_bits / 100.0, 32, 2);
}

}  // namespace
}  // namespace understory
