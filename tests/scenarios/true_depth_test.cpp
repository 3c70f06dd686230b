#include "scenarios/parts/oracles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "scenarios/course/courses.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/parts/synthetic_detector.hpp"
#include "tests/perception/rigs.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

/// It looks level along world x: camera x = world -y, camera y = world -z, camera z = world x.
StereoRig paper_rig() {
  StereoRig rig = support::paper_rig();
  rig.detection_depth_m = 4.8;
  return rig;
}

struct Scene {
  TruthHistory history;
  StereoFrame frame;
  Scene() {
    Truth truth;
    truth.T_world_body.translation().z() = 3;
    history.observe(truth);
  }
};

TEST(RayMeetsWall, ClosedForms) {
  const Obstacle wall{"wall", {10, -5, 0}, {10, 5, 8}, 0.2, 0, 0, ObstacleKind::wall};
  const Vector3d x = Vector3d::UnitX();
  EXPECT_NEAR(ray_meets_wall({0, 0, 1}, x, wall), 9.8, 1e-12);
  EXPECT_NEAR(ray_meets_wall({0, 0, 1}, {2, 0.5, 0.2}, wall), 4.9, 1e-12);
  EXPECT_NEAR(ray_meets_wall({20, 0, 1}, -x, wall), 9.8, 1e-12);         // its back
  EXPECT_NEAR(ray_meets_wall({10, 0, 10}, {0, 0, -1}, wall), 2, 1e-12);  // its top
  for (const Vector3d& past : {Vector3d(0, 0, 8.1), Vector3d(0, 5.1, 1), Vector3d(11, 0, 1)})
    EXPECT_EQ(ray_meets_wall(past, x, wall), std::numeric_limits<double>::infinity());
  // 45 degrees across the way: 0.2 m of half thickness are 0.2 sqrt 2 along it.
  const Obstacle turned{"wall", {7, -3, 0}, {13, 3, 8}, 0.2, 0, 0, ObstacleKind::wall};
  EXPECT_NEAR(ray_meets_wall({0, 0, 1}, x, turned), 10 - 0.2 * std::sqrt(2), 1e-12);
}

/// A wall at the detection depth fills the view with hits at its depth, banked or not.
TEST(TrueDepth, AWallIsSeenWhereItStands) {
  TruthHistory history;
  Truth truth;
  truth.T_world_body = Eigen::Translation3d(0, 0, 3) * Eigen::AngleAxisd(0.6, Vector3d::UnitX());
  history.observe(truth);
  const Obstacle wall{"wall", {5, -20, 0}, {5, 20, 20}, 0.2, 0, 0, ObstacleKind::wall};
  TrueDepth detector(paper_rig(), {wall}, history);
  const auto& hits = detector.detect({0, {}, {}});
  EXPECT_GT(hits.size(), 2000u);
  for (const StereoHit& hit : hits) EXPECT_NEAR(hit.position_camera.z(), 4.8, 1e-9);
}

TEST(RayMeetsBar, ClosedForms) {
  const Vector3d x = Vector3d::UnitX();
  EXPECT_NEAR(ray_meets_round_obstacle({0, 0, 1}, x, {5, 0, 0}, {5, 0, 9}, 0.2), 4.8, 1e-12);
  EXPECT_NEAR(ray_meets_round_obstacle({0, 0.12, 1}, x, {5, 0, 0}, {5, 0, 9}, 0.2),
              5 - std::sqrt(0.04 - 0.0144), 1e-12);
  const double miss = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ray_meets_round_obstacle({0, 0.21, 1}, x, {5, 0, 0}, {5, 0, 9}, 0.2), miss);
  EXPECT_EQ(ray_meets_round_obstacle({0, 0, 10}, x, {5, 0, 0}, {5, 0, 9}, 0.2), miss);  // above its top
  EXPECT_EQ(ray_meets_round_obstacle({9, 0, 1}, x, {5, 0, 0}, {5, 0, 9}, 0.2), miss);   // behind
  EXPECT_NEAR(ray_meets_round_obstacle({0, 0, 1}, 2 * x, {5, -3, 1}, {5, 3, 1}, 0.2), 2.4,
              1e-12);  // multiples, a level bar
}

// One pixel either way of the paper rig's detection depth is 4.47 to 5.20 m.
TEST(TrueDepth, SeesOnePixelEitherWay) {
  Scene scene;
  const TrueDepth detector(paper_rig(), {}, scene.history);
  EXPECT_NEAR(detector.interval().near_m, 4.47, 0.02);
  EXPECT_NEAR(detector.interval().far_m, 5.20, 0.02);
  const std::vector<Obstacle> trunk{{"tree", {9.3, 0, 0}, {9.3, 0, 9}, 0.25, 0, 0}};
  EXPECT_TRUE(TrueDepth(paper_rig(), trunk, scene.history).detect(scene.frame).empty());
  TrueDepth both(paper_rig(), trunk, scene.history, intervals_around({4.8, 9.1}, paper_rig()));
  EXPECT_FALSE(both.detect(scene.frame).empty());
}

TEST(TrueDepth, HitsLieOnTheTrunkAndCoverIt) {
  Scene scene;
  const StereoRig rig = paper_rig();
  const double x = 5.0;
  const double radius = 0.25;
  TrueDepth detector(rig, {{"tree", {x, 0, 0}, {x, 0, 9}, radius, 0, 0}}, scene.history);
  const auto hits = detector.detect(scene.frame);
  for (const StereoHit& hit : hits) {
    const Vector3d world = Vector3d(0, 0, 3) + rig.T_body_camera * hit.position_camera;
    EXPECT_NEAR(std::hypot(world.x() - x, world.y()), radius, 1e-9);
    EXPECT_NEAR(hit.disparity_px, rig.disparity_px(hit.position_camera.z()), 1e-9);
    EXPECT_EQ(hit.column_px % 5, 0);
    EXPECT_EQ(hit.row_px % 5, 0);
  }
  // Half the trunk's width as seen: tan(asin(r / x)) * f = 9.03 px either side of column 197.5: block centres
  // 192, 197 and 202 lie within; every one of the 42 rows of blocks looks at the trunk (none below its foot).
  EXPECT_EQ(
      hits.size(), 3u * 42u - [&] {
        std::size_t below = 0;
        for (int row = 0; row <= 205; row += 5) {
          const double slope = (row + 2 - rig.center_y_px) / rig.focal_px;
          if (3 - slope * x < 0) below += 3;
        }
        return below;
      }());
}

TEST(TrueDepth, NearerBarsHideFartherOnes) {
  Scene scene;
  const std::vector<Obstacle> far{{"far", {5, 0, 0}, {5, 0, 9}, 0.2, 0, 0}};
  std::vector<Obstacle> both = far;
  both.push_back({"near", {2, 0, 0}, {2, 0, 9}, 0.2, 0, 0});
  EXPECT_FALSE(TrueDepth(paper_rig(), far, scene.history).detect(scene.frame).empty());
  EXPECT_TRUE(TrueDepth(paper_rig(), both, scene.history).detect(scene.frame).empty());
}

TEST(TrueDepth, NothingAtOtherDepths) {
  Scene scene;
  for (const double x : {3.5, 4.3, 6.0, 20.0, -5.0}) {
    EXPECT_TRUE(TrueDepth(paper_rig(), {{"tree", {x, 0, 0}, {x, 0, 9}, 0.15, 0, 0}}, scene.history)
                    .detect(scene.frame)
                    .empty())
        << x;
  }
}

/// A wall across the view, all of it at one depth, 400 frames of the same moment. 75 columns and 42 rows of
/// blocks see it.
struct SyntheticWall {
  Scene scene;
  StereoRig rig = paper_rig();
  std::vector<Obstacle> wall{{"wall", {5, -50, -50}, {5, 50, 50}, 0.2, 0, 0, ObstacleKind::wall}};
  static constexpr int frames = 400;

  std::vector<std::vector<StereoHit>> seen(const SyntheticConfig& config, DepthInterval reach = {1.5, 15}) {
    SyntheticDetector detector(rig, wall, scene.history, config, reach, 3);
    std::vector<std::vector<StereoHit>> all;
    for (int i = 0; i < frames; ++i) all.push_back(detector.detect(scene.frame));
    return all;
  }
};

/// Mean and variance of a count.
std::pair<double, double> moments_of(const std::vector<std::vector<StereoHit>>& frames) {
  double sum = 0, squares = 0;
  for (const auto& hits : frames) sum += hits.size(), squares += 1.0 * hits.size() * hits.size();
  const double n = frames.size(), mean = sum / n;
  return {mean, squares / n - mean * mean};
}

TEST(Synthetic, WithoutFaultsItSeesTheTruth) {
  SyntheticWall scene;
  const auto frames = scene.seen({});
  EXPECT_EQ(frames[0].size(), 75u * 42u);
  for (const StereoHit& hit : frames[0]) EXPECT_NEAR(hit.position_camera.z(), 4.8, 1e-9);
  EXPECT_TRUE(scene.seen({}, {1.5, 4.7})[0].empty());  // beyond its reach
  SyntheticConfig other;
  other.depths_m = {9.6};
  EXPECT_TRUE(scene.seen(other)[0].empty());
  other.depths_m = {9.6, 4.8};
  EXPECT_EQ(scene.seen(other)[0].size(), 75u * 42u);
}

/// Blocks are missed as coins fall: binomial. Frames are missed whole.
TEST(Synthetic, MissesTheShareThatItsKeysSay) {
  SyntheticWall scene;
  const double blocks = 75 * 42;
  SyntheticConfig config;
  config.missed_blocks = 0.3;
  const auto [mean, variance] = moments_of(scene.seen(config));
  EXPECT_NEAR(mean, 0.7 * blocks, 4 * std::sqrt(0.21 * blocks / SyntheticWall::frames));
  EXPECT_NEAR(variance, 0.21 * blocks, 4 * 0.21 * blocks * std::sqrt(2.0 / SyntheticWall::frames));
  config = {};
  config.missed_frames = 0.25;
  int missed = 0;
  for (const auto& hits : scene.seen(config)) {
    EXPECT_TRUE(hits.empty() || hits.size() == blocks);
    missed += hits.empty();
  }
  EXPECT_NEAR(missed, 100, 4 * std::sqrt(400 * 0.1875));
}

/// 300 trunks side by side; a tree of several pieces is one.
TEST(Synthetic, MissesObstaclesForGood) {
  Scene scene;
  std::vector<Obstacle> trunks;
  int never = 0;
  SyntheticConfig config;
  config.missed_obstacles = 0.4;
  for (int seed = 0; seed < 300; ++seed) {
    trunks.assign(2, {"tree", {4.8, 0, 0}, {4.8, 0, 3}, 0.2, 0, 0});
    trunks[1].from_world.z() = 3, trunks[1].to_world.z() = 9;
    for (Obstacle& piece : trunks) piece.tree = 7;
    SyntheticDetector detector(paper_rig(), trunks, scene.history, config, {1.5, 15},
                               static_cast<std::uint64_t>(seed));
    const std::size_t first = detector.detect(scene.frame).size();
    EXPECT_TRUE(first == 0 || first > 100) << first;  // both pieces or none
    EXPECT_EQ(detector.detect(scene.frame).size(), first);
    never += first == 0;
  }
  EXPECT_NEAR(never, 120, 4 * std::sqrt(300 * 0.24));
}

/// Poisson: mean and variance are equal; rows in order; depths within what is looked at.
TEST(Synthetic, FalsePointsArePoisson) {
  SyntheticWall scene;
  scene.wall.clear();
  SyntheticConfig config;
  config.false_points = 12;
  const auto frames = scene.seen(config, {3, 9});
  const auto [mean, variance] = moments_of(frames);
  EXPECT_NEAR(mean, 12, 4 * std::sqrt(12.0 / SyntheticWall::frames));
  EXPECT_NEAR(variance, 12, 4 * 12 * std::sqrt(2.1 / SyntheticWall::frames));
  double sum_m = 0;
  int count = 0;
  for (const auto& hits : frames)
    for (std::size_t i = 0; i < hits.size(); ++i) {
      EXPECT_GE(hits[i].position_camera.z(), 3);
      EXPECT_LE(hits[i].position_camera.z(), 9);
      if (i > 0) {
        EXPECT_LE(hits[i - 1].row_px, hits[i].row_px);
      }
      sum_m += hits[i].position_camera.z(), ++count;
    }
  EXPECT_NEAR(sum_m / count, 6, 4 * 6 / std::sqrt(12.0) / std::sqrt(count));
}

/// Of disparity, so that depths spread by z^2 / (f b) of it.
TEST(Synthetic, ErrorsAreOfDisparity) {
  SyntheticWall scene;
  SyntheticConfig config;
  config.disparity_error_px = 0.5;
  const auto frames = scene.seen(config);
  double sum = 0, squares = 0, depths_m = 0, depth_squares = 0, n = 0;
  const double exact_px = scene.rig.disparity_px(4.8);
  for (const StereoHit& hit : frames[0]) {
    const double error_px = hit.disparity_px - exact_px, z = hit.position_camera.z();
    EXPECT_NEAR(scene.rig.disparity_px(z), hit.disparity_px, 1e-9);
    sum += error_px, squares += error_px * error_px, depths_m += z, depth_squares += z * z, ++n;
  }
  EXPECT_NEAR(sum / n, 0, 4 * 0.5 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.5, 4 * 0.5 / std::sqrt(2 * n));
  const double spread_m = std::sqrt(depth_squares / n - depths_m * depths_m / n / n);
  EXPECT_NEAR(spread_m, 0.5 * 4.8 * 4.8 / (scene.rig.focal_px * scene.rig.baseline_m), 0.05 * spread_m);
}

/// Any keys that a scenario may have, at their bounds too: every hit is a point before the camera.
TEST(Synthetic, WhateverItsKeysSayItsHitsLieBeforeTheCamera) {
  SyntheticWall scene;
  std::mt19937_64 generator(5);
  const auto any_of = [&](std::vector<double> values) { return values[generator() % values.size()]; };
  for (int i = 0; i < 300; ++i) {
    SyntheticConfig config{{},
                           any_of({0, 0.5, 1}),
                           any_of({0, 0.5, 1}),
                           any_of({0, 0.9, 1}),
                           any_of({0, 3, 1000}),
                           any_of({0, 0.3, 20})};
    for (std::uint64_t n = generator() % 4; n > 0; --n)
      config.depths_m.push_back(any_of({0.1, 2, 4.8, 60, 1000}));
    SyntheticDetector detector(scene.rig, scene.wall, scene.scene.history, config,
                               {any_of({0.1, 1.5, 90}), 15000}, generator());
    for (const StereoHit& hit : detector.detect(scene.scene.frame)) {
      ASSERT_TRUE(hit.position_camera.allFinite() && hit.position_camera.z() > 0) << hit.position_camera.z();
      ASSERT_TRUE(std::isfinite(hit.disparity_px));
    }
  }
}

TEST(SegmentDistance, ClosedForms) {
  EXPECT_NEAR(segment_distance_m({{-1, 0, 0}, {1, 0, 0}}, {{0, -1, 2}, {0, 1, 2}}), 2,
              1e-12);  // skew, both inside
  EXPECT_NEAR(segment_distance_m({{0, 0, 0}, {1, 0, 0}}, {{4, 4, 0}, {4, 9, 0}}), 5,
              1e-12);  // end to end: 3-4-5
  EXPECT_NEAR(segment_distance_m({{0, 0, 0}, {2, 0, 0}}, {{1, 3, 0}, {5, 3, 0}}), 3,
              1e-12);  // parallel, beside
  EXPECT_NEAR(segment_distance_m({{0, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, {5, 0, 0}}), 1, 1e-12);   // on one line
  EXPECT_NEAR(segment_distance_m({{0, 0, 0}, {1, 1, 0}}, {{0, 1, 0}, {1, 0, 0}}), 0, 1e-12);   // crossing
  EXPECT_NEAR(segment_distance_m({{0, 0, 1}, {0, 0, 1}}, {{-1, 0, 0}, {1, 0, 0}}), 1, 1e-12);  // a point
  EXPECT_NEAR(segment_distance_m({{-1, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}), 1, 1e-12);
}

// Against a plain search over both parameters.
TEST(SegmentDistance, AgreesWithSearch) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vector3d(unit(generator), unit(generator), unit(generator)); };
  for (int trial = 0; trial < 50; ++trial) {
    const Segment a{point(), point()};
    const Segment b{point(), point()};
    double minimum = 10;
    for (int i = 0; i <= 200; ++i) {
      for (int k = 0; k <= 200; ++k) {
        minimum = std::min(
            minimum, (a.from + i / 200.0 * (a.to - a.from) - b.from - k / 200.0 * (b.to - b.from)).norm());
      }
    }
    EXPECT_LE(segment_distance_m(a, b), minimum + 1e-12);
    EXPECT_NEAR(segment_distance_m(a, b), minimum, 0.02);
  }
}

Obstacle wall(const Vector3d& from, const Vector3d& to, double radius_m) {
  return {"wall", from, to, radius_m, 0, 0, ObstacleKind::wall};
}

TEST(ObstacleDistance, OfAWallInClosedForms) {
  const Obstacle facade = wall({10, -5, 0}, {10, 5, 8}, 0.2);
  const auto from = [&](const Vector3d& a, const Vector3d& b) { return obstacle_distance_m({a, b}, facade); };
  EXPECT_NEAR(from({4, 0, 4}, {6, 1, 3}), 4 - 0.2, 1e-12);     // an end before its face
  EXPECT_NEAR(from({9, 0, 4}, {11, 1, 4}), -0.2, 1e-12);       // through
  EXPECT_NEAR(from({9, 0, 11}, {11, 1, 11}), 3 - 0.2, 1e-12);  // over its upper edge
  EXPECT_NEAR(from({13, 9, 2}, {13, 9, 2}), 5 - 0.2, 1e-12);   // 3-4-5 to its side
  EXPECT_NEAR(from({10, 8, 2}, {10, 7, 2}), 2 - 0.2, 1e-12);   // in its plane, beside
}

// Against a plain search over the segment and the rectangle.
TEST(ObstacleDistance, OfAWallAgreesWithSearch) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vector3d(unit(generator), unit(generator), unit(generator)); };
  for (int trial = 0; trial < 40; ++trial) {
    const Segment segment{2 * point(), 2 * point()};
    const Vector3d from = point(), to = point();
    double minimum = 10;
    for (int i = 0; i <= 50; ++i)
      for (int k = 0; k <= 50; ++k)
        for (int m = 0; m <= 50; ++m) {
          const Vector3d on_wall(from.x() + i / 50.0 * (to.x() - from.x()),
                                 from.y() + i / 50.0 * (to.y() - from.y()),
                                 from.z() + k / 50.0 * (to.z() - from.z()));
          minimum =
              std::min(minimum, (segment.from + m / 50.0 * (segment.to - segment.from) - on_wall).norm());
        }
    const double found = obstacle_distance_m(segment, wall(from, to, 0));
    EXPECT_LE(found, minimum + 1e-12);
    EXPECT_NEAR(found, minimum, 0.06);
  }
}

TEST(Clearance, ABankedWingFitsWhereALevelOneDoesNot) {
  const Airframe airframe;
  const double half_span_m = airframe.span_m / 2;
  const std::vector<Obstacle> trunk{{"tree", {0, 1, 0}, {0, 1, 9}, 0.2, 0, 0}};
  Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
  level.translation() = Vector3d(-airframe.winglet_x_m, 0, 3);  // the wing's line abreast of the trunk
  EXPECT_NEAR(clearance_m(level, airframe, trunk), 1 - 0.2 - half_span_m, 1e-12);
  Eigen::Isometry3d banked = level;
  banked.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(clearance_m(banked, airframe, trunk), 1 - 0.2, 1e-12);
}

TEST(Clearance, InsideIsNegativeAndNothingIsInfinite) {
  const Airframe airframe;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 3;
  EXPECT_LT(clearance_m(pose, airframe, {{"tree", {0, 0, 0}, {0, 0, 9}, 0.2, 0, 0}}), 0);
  EXPECT_EQ(clearance_m(pose, airframe, {}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace understory
