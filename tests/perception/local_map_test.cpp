#include "perception/map/local_map.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "perception/io/calibration/calibration_file.hpp"

namespace understory {
namespace {

constexpr std::int64_t second = 1'000'000'000;

StereoHit hit_at(double x, double y, double z, double score = 0.1) {
  StereoHit hit;
  hit.position_camera = {x, y, z};
  hit.score = score;
  return hit;
}

Eigen::Isometry3d at(double x, double y, double z, double yaw_deg = 0, double roll_deg = 0) {
  const double to_rad = std::numbers::pi / 180;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  T.linear() = (Eigen::AngleAxisd(yaw_deg * to_rad, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(roll_deg * to_rad, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T;
}

TEST(LocalMap, CarriesAHitIntoTheWorld) {
  LocalMap map{{}};
  // A camera at (1, 2, 3) looking north: right is east, down is down.
  const Eigen::Isometry3d T_body_camera = T_body_camera_of({0, 0, 0}, 0);
  map.insert({hit_at(0.5, 0.25, 10)}, at(1, 2, 3, 90) * T_body_camera, 7 * second, 42.0);
  ASSERT_EQ(map.points().size(), 1u);
  const ObstaclePoint& point = map.points()[0];
  EXPECT_TRUE(point.position_world.isApprox(Eigen::Vector3d(1.5, 12, 2.75), 1e-12));
  EXPECT_EQ(point.t_ns, 7 * second);
  EXPECT_DOUBLE_EQ(point.distance_flown_m, 42.0);
  EXPECT_DOUBLE_EQ(point.score, 0.1);
}

TEST(LocalMap, ForgetsWhatIsPassedOnceItIsFarEnoughBehind) {
  LocalMap map{{.passed_m = 2.0}};
  map.insert({hit_at(10, 0, 0)}, at(0, 0, 0), 0, 0);
  for (const double x : {0.0, 9.0, 11.0, 11.9}) {
    map.forget_passed(at(x, 0, 0), second);
    EXPECT_EQ(map.points().size(), 1u) << x;
  }
  map.forget_passed(at(12.1, 0, 0), second);
  EXPECT_TRUE(map.points().empty());
}

TEST(LocalMap, KeepsWhatIsBesideTheWingsInABankedTurn) {
  LocalMap map{{.passed_m = 2.0}};
  // Abreast, half a metre beyond each wing tip, and one above and below.
  map.insert({hit_at(0, 0.9, 0), hit_at(0, -0.9, 0), hit_at(0, 0, 3), hit_at(0, 0, -3)}, at(0, 0, 5), 0, 0);
  for (const double yaw_deg : {-80.0, 0.0, 80.0})
    for (const double roll_deg : {-90.0, -60.0, 0.0, 60.0, 90.0}) {
      map.forget_passed(at(0, 0, 5, yaw_deg, roll_deg), second);
      EXPECT_EQ(map.points().size(), 4u) << yaw_deg << " " << roll_deg;
    }
  // Nose straight up: nothing is behind.
  Eigen::Isometry3d climbing = at(0, 0, 100);
  climbing.linear() = Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  map.forget_passed(climbing, second);
  EXPECT_EQ(map.points().size(), 4u);
}

TEST(LocalMap, ForgetsByAge) {
  LocalMap map{{.max_age_s = 4.0}};
  map.insert({hit_at(10, 0, 0)}, at(0, 0, 0), second, 0);
  map.insert({hit_at(20, 0, 0)}, at(0, 0, 0), 2 * second, 0);
  map.forget_passed(at(0, 0, 0), 5 * second);
  EXPECT_EQ(map.points().size(), 2u);
  map.forget_passed(at(0, 0, 0), 5 * second + 1);
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_EQ(map.points()[0].t_ns, 2 * second);
}

TEST(LocalMap, IsBoundedAndDropsTheOldestSightings) {
  LocalMap map{{.max_points = 10}};
  for (int i = 0; i < 25; ++i) map.insert({hit_at(i, 0, 0)}, at(0, 0, 0), i * second / 100, i);
  ASSERT_EQ(map.points().size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_DOUBLE_EQ(map.points()[i].position_world.x(), 15.0 + double(i));
  // Seen again, the first becomes the newest and outlives the second.
  map.insert({hit_at(15.01, 0, 0)}, at(0, 0, 0), second, 30);
  map.insert({hit_at(99, 0, 0)}, at(0, 0, 0), second, 31);
  ASSERT_EQ(map.points().size(), 10u);
  EXPECT_DOUBLE_EQ(map.points()[0].position_world.x(), 15.01);
  EXPECT_DOUBLE_EQ(map.points()[1].position_world.x(), 17.0);
}

TEST(LocalMap, RefreshesAPointSeenAgain) {
  LocalMap map{{.voxel_m = 0.10}};
  map.insert({hit_at(1.02, 0.05, 0.05, 0.1), hit_at(1.03, 0.05, 0.05, 0.2)}, at(0, 0, 0), second, 1);
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_EQ(map.points()[0].sightings, 1);  // twice in one frame is once
  map.insert({hit_at(1.08, 0.05, 0.05, 0.3), hit_at(1.12, 0.05, 0.05)}, at(0, 0, 0), 2 * second, 2);
  ASSERT_EQ(map.points().size(), 2u);  // 1.12 lies in the next voxel
  EXPECT_EQ(map.points()[0].sightings, 2);
  EXPECT_DOUBLE_EQ(map.points()[0].position_world.x(), 1.08);
  EXPECT_DOUBLE_EQ(map.points()[0].score, 0.3);
  EXPECT_DOUBLE_EQ(map.points()[0].distance_flown_m, 2);

  LocalMap every{{.voxel_m = 0}};
  every.insert({hit_at(1, 1, 1), hit_at(1, 1, 1)}, at(0, 0, 0), 0, 0);
  EXPECT_EQ(every.points().size(), 2u);
}

TEST(LocalMap, TrustsExactlyThePointsWithEnoughNeighbours) {
  LocalMap map{{.max_age_s = 100, .voxel_m = 0.01, .min_neighbours = 3, .neighbour_radius_m = 0.7}};
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> place(-4, 4);
  for (int frame = 0; frame < 40; ++frame) {
    std::vector<StereoHit> hits;
    for (int i = 0; i < 15; ++i) hits.push_back(hit_at(place(generator), place(generator), place(generator)));
    map.insert(hits, at(0, 0, 0), frame * second / 120, 0);
  }
  std::vector<Eigen::Vector3d> expected_positions;
  for (const ObstaclePoint& point : map.points()) {
    int near = -1;  // it finds itself
    for (const ObstaclePoint& other : map.points())
      near += (other.position_world - point.position_world).norm() <= 0.7;
    if (near >= 3) expected_positions.push_back(point.position_world);
  }
  const auto trusted = map.trusted_points();
  ASSERT_EQ(trusted.size(), expected_positions.size());
  EXPECT_GT(trusted.size(), 20u);
  EXPECT_LT(trusted.size(), map.points().size());
  for (std::size_t i = 0; i < trusted.size(); ++i)
    EXPECT_EQ(trusted[i].position_world, expected_positions[i]);
}

TEST(LocalMap, CanAskForASecondFrame) {
  LocalMapConfig config;
  config.seen_again = true;
  LocalMap map{config};
  const std::vector<StereoHit> group{hit_at(10, 0, 0), hit_at(10.2, 0, 0), hit_at(10, 0.2, 0)};
  map.insert(group, at(0, 0, 0), second, 0);
  EXPECT_TRUE(map.trusted_points().empty());
  map.insert(group, at(0.3, 0, 0), second + second / 120, 0);  // moved on: 0.3 m from the first sighting
  EXPECT_EQ(map.trusted_points().size(), 6u);
  LocalMap single{config};
  single.insert(group, at(0, 0, 0), second, 0);
  single.insert({hit_at(30, 0, 0)}, at(0, 0, 0), 2 * second, 0);
  EXPECT_TRUE(single.trusted_points().empty());
}

}  // namespace
}  // namespace understory
