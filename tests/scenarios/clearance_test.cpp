#include "scenarios/flight/clearance.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace understory {
namespace {

using Eigen::Vector3d;

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
