#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/course/courses.hpp"

namespace understory {
namespace {

TEST(Forest, TreesStandWithinBounds) {
  const ForestConfig config;
  for (const Obstacle& tree : random_forest(config, 1000)) {
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
    const double count = static_cast<double>(random_forest(config, static_cast<std::uint64_t>(seed)).size());
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
    for (const Obstacle& tree : random_forest(config, seed)) {
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
  const auto first = random_forest(config, 7);
  const auto again = random_forest(config, 7);
  const auto other = random_forest(config, 8);
  ASSERT_EQ(first.size(), again.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].from_world, again[i].from_world);
  EXPECT_NE(first.front().from_world, other.front().from_world);
}

TEST(Goalposts, ArePassedWithinTheirDistances) {
  const GoalpostsConfig config;
  int left = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto obstacles = goalposts(config, seed);
    ASSERT_EQ(obstacles.size(), 3u);
    const double near_y = obstacles[0].from_world.y();
    const double far_y = obstacles[1].from_world.y();
    EXPECT_GE(std::abs(near_y) - config.radius_m, 0.5);
    EXPECT_LE(std::abs(near_y) - config.radius_m, 2.0);
    EXPECT_LT(near_y * far_y, 0);  // the course runs between the uprights
    const double between_axes_m = (obstacles[0].from_world - obstacles[1].from_world).norm();
    EXPECT_NEAR(between_axes_m - 2 * config.radius_m, 5.639, 1e-12);  // 18 ft 6 in
    EXPECT_NEAR(obstacles[2].from_world.z() + obstacles[2].radius_m, 3.048, 1e-12);
    left += near_y > 0;
  }
  EXPECT_NEAR(left, 100, 30);
}

TEST(Windows, StandBehindTheGoal) {
  const WindowsConfig config;
  const auto walls = windows(config, 60);
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(walls[0].kind, ObstacleKind::wall);
  EXPECT_NEAR(walls[0].from_world.x() - walls[0].radius_m, 72, 1e-12);  // its face
  EXPECT_EQ(walls[0].to_world - walls[0].from_world, Eigen::Vector3d(0, 60, 20));
}

TEST(Fence, PalingsStandInRowsWithGates) {
  const FenceConfig config;
  int across = 0, beside = 0, rails = 0;
  for (const Obstacle& obstacle : fence(config, 75)) {
    if (obstacle.kind == ObstacleKind::rail) {
      ++rails;
      EXPECT_NEAR(obstacle.from_world.z(), obstacle.to_world.z(), 1e-12);
      EXPECT_GT(std::abs(obstacle.from_world.y()), 1.49);
      continue;
    }
    EXPECT_EQ(obstacle.kind, ObstacleKind::post);
    EXPECT_EQ(obstacle.from_world.z(), 0);
    EXPECT_EQ(obstacle.to_world.z(), config.height_m);
    const bool is_across = obstacle.name.rfind("across", 0) == 0;
    (is_across ? across : beside) += 1;
    EXPECT_GE(std::abs(obstacle.from_world.y()), 0.5 * config.opening_m - 1e-12);
    EXPECT_LE(std::abs(obstacle.from_world.y()), config.reach_m + 1e-12);
    if (is_across)
      EXPECT_TRUE(obstacle.from_world.x() == 30 || obstacle.from_world.x() == 55) << obstacle.name;
    else
      EXPECT_NEAR(obstacle.from_world.y(), 3.5, 1e-12);
  }
  EXPECT_EQ(across, 2 * 2 * 34);  // 13.5 m in steps of 0.4 m, at both ends
  EXPECT_EQ(beside, 112);         // 44.6 m
  EXPECT_EQ(rails, 2 * 5);
  const auto obstacles = fence(config, 75);
  double closest_m = 10;
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      closest_m = std::min(closest_m, (obstacles[i].from_world - obstacles[k].from_world).norm());
  EXPECT_GT(closest_m, 2 * config.paling_radius_m);  // no two in one place
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
