#include "perception/map/resightings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace understory {
namespace {

/// An aircraft flying east at 12 m/s past poles, and a detector that sees a pole while it crosses the depth
/// interval of a pixel, and puts it at the depth.
struct Course {
  std::vector<Eigen::Vector2d> poles_world{{20.0, 0.4}};
  Eigen::Vector2d velocity_error_mps{0, 0};  ///< of the odometry
  int rows = 4;                              ///< hits of one pole in one frame
};

constexpr double speed_mps = 12;
constexpr std::int64_t frame_ns = 8'333'333;

ResightingsConfig two_depths() {
  ResightingsConfig config;
  config.enabled = true;
  config.depths_m = {5, 10};
  return config;
}

std::vector<Resighting> fly(const Course& course, const ResightingsConfig& config) {
  constexpr double focal_baseline_px_m = 60;
  Resightings resightings(config);
  std::vector<Resighting> all;
  for (std::int64_t t_ns = 0; t_ns < 2'000'000'000; t_ns += frame_ns) {
    const double t_s = 1e-9 * static_cast<double>(t_ns);
    const Eigen::Vector2d truly_at(speed_mps * t_s, 0);
    std::vector<StereoHit> hits;
    for (const Eigen::Vector2d& pole : course.poles_world)
      for (const double depth_m : config.depths_m)
        for (int row = 0; row < course.rows; ++row) {
          const Eigen::Vector2d away = pole - truly_at;
          if (away.x() <= 0 || std::abs(focal_baseline_px_m * (1 / away.x() - 1 / depth_m)) > 0.5) continue;
          // Camera axes: x right, y down, z forward.
          StereoHit hit;
          hit.position_camera = depth_m / away.x() * Eigen::Vector3d(-away.y(), 0.2 * row, away.x());
          hits.push_back(hit);
        }
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T_world_camera.translation().head<2>() = truly_at + course.velocity_error_mps * t_s;
    T_world_camera.translation().z() = 3;
    resightings.insert(hits, T_world_camera, t_ns);
    all.insert(all.end(), resightings.completed().begin(), resightings.completed().end());
  }
  return all;
}

/// When a pole 20 m away is 10 m, and 5 m, ahead.
constexpr double far_s = 10 / speed_mps, near_s = 15 / speed_mps;
/// Where in the depth interval a pole stands when frames begin and end to see it: half the way of a frame at
/// either depth; and the interval's middle in disparity is not quite that in depth.
constexpr double place_m = 0.12, moment_s = 0.01;

TEST(Resightings, WithPerfectOdometryMissByNothing) {
  const std::vector<Resighting> seen = fly({}, two_depths());
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_LT(seen[0].discrepancy_world_m.norm(), place_m);
  EXPECT_NEAR(1e-9 * static_cast<double>(seen[0].earlier_ns), far_s, moment_s);
  EXPECT_NEAR(1e-9 * static_cast<double>(seen[0].t_ns), near_s, moment_s);
}

TEST(Resightings, MissByTheVelocityErrorTimesTheInterval) {
  const Eigen::Vector2d still = fly({}, two_depths()).at(0).discrepancy_world_m;
  for (const Eigen::Vector2d& error :
       {Eigen::Vector2d(1.2, 0), Eigen::Vector2d(-1.2, 0), Eigen::Vector2d(0.4, -0.9)}) {
    Course course;
    course.velocity_error_mps = error;
    const std::vector<Resighting> seen = fly(course, two_depths());
    ASSERT_EQ(seen.size(), 1u);
    // An odometry that runs ahead puts the nearer sighting too far ahead: the sign is the error's own.
    const Eigen::Vector2d expected = (near_s - far_s) * error;
    EXPECT_LT((seen[0].discrepancy_world_m - expected).norm(), place_m);
    // And what the depth intervals leave is the same whatever the odometry says.
    EXPECT_LT((seen[0].discrepancy_world_m - still - expected).norm(), 0.02);
  }
}

TEST(Resightings, AreLessSureAlongTheLineOfSightThanAcrossIt) {
  const ResightingsConfig config = two_depths();
  const Resighting seen = fly({}, config).at(0);
  const Eigen::Vector2d along = Eigen::Vector2d(5, 0.4).normalized(), across(-along.y(), along.x());
  EXPECT_NEAR(std::sqrt(along.dot(seen.covariance_m2 * along)), config.along_sigma_m, 0.002);
  EXPECT_NEAR(std::sqrt(across.dot(seen.covariance_m2 * across)), config.across_sigma_m, 0.002);
}

/// The odometry runs 2.2 m ahead between the depths. Poles 2.2 m apart: each one's second place misses its
/// first by 2.2 m and the other's by 3.1 m, less than one and a half times as much. Poles 4 m apart are told
/// apart.
TEST(Resightings, OfPolesThatCouldBeTakenForEachOtherAreNone) {
  Course course;
  course.velocity_error_mps = {2.2 / (near_s - far_s), 0};
  course.poles_world = {{20, -1.1}, {20, 1.1}};
  EXPECT_TRUE(fly(course, two_depths()).empty());
  course.poles_world = {{20, -2.0}, {20, 2.0}};
  const std::vector<Resighting> seen = fly(course, two_depths());
  ASSERT_EQ(seen.size(), 2u);
  for (const Resighting& one : seen)
    EXPECT_LT((one.discrepancy_world_m - Eigen::Vector2d(2.2, 0)).norm(), 0.25);
}

TEST(Resightings, OfFewHitsAreNone) {
  Course course;
  course.rows = 1;  // the nearer depth's interval, 0.4 m, is crossed in four frames
  ResightingsConfig config = two_depths();
  EXPECT_TRUE(fly(course, config).empty());
  config.minimum_hits = 3;
  EXPECT_EQ(fly(course, config).size(), 1u);
}

TEST(Resightings, NeedTwoDepthsAndToBeAskedFor) {
  ResightingsConfig config = two_depths();
  config.depths_m = {10};
  EXPECT_TRUE(fly({}, config).empty());
  config = two_depths();
  config.enabled = false;
  EXPECT_TRUE(fly({}, config).empty());
}

TEST(Resightings, FartherThanTheMatchAreNone) {
  Course course;
  course.velocity_error_mps = {1.2 * two_depths().match_m / (near_s - far_s), 0};
  EXPECT_TRUE(fly(course, two_depths()).empty());
}

}  // namespace
}  // namespace understory
