#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "tests/sim/camera_scenes.hpp"

namespace understory {
namespace {

TEST(StereoCameras, DepthOfAWallIsItsDistanceAlongTheAxisEverywhere) {
  const World world = bare_world("<geom type='box' size='.5 50 50' pos='5.5 0 0'/>");
  StereoCameras cameras(world, paper_rig(), noiseless(), {1, 1});
  const cv::Mat depth = cameras.depth(body_at({0, 0, 0}, level));
  double minimum = 0, maximum = 0;
  cv::minMaxLoc(depth, &minimum, &maximum);
  EXPECT_NEAR(minimum, 5.0, 0.001);
  EXPECT_NEAR(maximum, 5.0, 0.001);
}

TEST(StereoCameras, DepthOfTheGroundIsTheRaysOwn) {
  const World world = forest_world(false);
  const StereoRig rig = paper_rig();
  StereoCameras cameras(world, rig, noiseless(), {1, 1});
  expect_depths_of_the_ground(cameras, rig);
}

TEST(StereoCameras, ABallAppearsWhereTheRigSays) {
  const StereoRig rig = paper_rig();
  // Forward, left and up of the left eye, in both eyes' fields of view.
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(5, 0.3, 0.1), Eigen::Vector3d(5, -2.0, 1.5),
                                    Eigen::Vector3d(4, 1.4, -1.1), Eigen::Vector3d(10, -3.1, -2)}) {
    const World world =
        bare_world("<geom type='sphere' size='.12' rgba='0 0 0 1' pos='" + std::to_string(at.x()) + " " +
                   std::to_string(at.y()) + " " + std::to_string(at.z()) + "'/>");
    StereoCameras cameras(world, rig, noiseless(), {1, 1});
    const StereoFrame frame = cameras.capture(body_at({0, 0, 0}, level), 0);
    const double x = -at.y(), y = -at.z(), z = at.x();
    const Eigen::Vector2d left = dark_centroid(frame.left), right = dark_centroid(frame.right);
    EXPECT_NEAR(left.x(), rig.focal_px * x / z + rig.center_left_x_px, 0.6);
    EXPECT_NEAR(left.y(), rig.focal_px * y / z + rig.center_y_px, 0.6);
    EXPECT_NEAR(right.x(), rig.focal_px * (x - rig.baseline_m) / z + rig.center_right_x_px, 0.6);
    EXPECT_NEAR(right.y(), rig.focal_px * y / z + rig.center_y_px, 0.6);
  }
}

TEST(StereoCameras, APlaneAtTheDetectionDistanceMatchesAtTheRigsDisparity) {
  const World world = forest_world(false);
  const StereoRig rig = paper_rig();
  StereoCameras cameras(world, rig, {.noise_gray = 2}, {1, 1});
  const StereoFrame frame = cameras.capture(body_at({10, 0, 4.81}, straight_down), 0);
  int best = 0;
  double minimum = std::numeric_limits<double>::max();
  for (int disparity = 95; disparity < 120; ++disparity) {
    const double difference = cv::norm(frame.left(cv::Rect(150, 0, 200, 240)),
                                       frame.right(cv::Rect(150 - disparity, 0, 200, 240)), cv::NORM_L1);
    if (difference < minimum) best = disparity, minimum = difference;
  }
  EXPECT_EQ(best, std::lround(rig.disparity_px(4.81)));
  EXPECT_EQ(best, 105);  // paper.yaml: infinity at 91.8, and 13.2 px at 4.81 m
}

TEST(StereoCameras, SameSeedSameImagesOtherSeedOtherNoiseOnTheSamePicture) {
  const World world = forest_world();
  const Eigen::Isometry3d body = body_at({0, 0, 3}, level);
  const auto pair = [&](std::uint64_t seed, double noise, int frames) {
    StereoCameras cameras(world, paper_rig(), {.noise_gray = noise}, {seed, seed});
    StereoFrame frame;
    for (int i = 0; i < frames; ++i) frame = cameras.capture(body, i);
    return frame;
  };
  const StereoFrame clean = pair(1, 0, 1), first = pair(1, 2, 1), again = pair(1, 2, 1),
                    other = pair(2, 2, 1);
  EXPECT_TRUE(equal(first.left, again.left) && equal(first.right, again.right));
  EXPECT_TRUE(equal(clean.left, pair(9, 0, 3).left));
  EXPECT_FALSE(equal(first.left, other.left));
  EXPECT_FALSE(equal(first.left, pair(1, 2, 2).left)) << "noise must differ from frame to frame";

  cv::Mat wide_noisy, wide_clean, noise;
  first.right.convertTo(wide_noisy, CV_32F);
  clean.right.convertTo(wide_clean, CV_32F);
  noise = wide_noisy - wide_clean;
  cv::Scalar mean, deviation;
  cv::meanStdDev(noise, mean, deviation);
  EXPECT_NEAR(mean[0], 0, 0.05);
  EXPECT_NEAR(deviation[0], std::sqrt(4 + 1.0 / 12), 0.05);
}

TEST(StereoCameras, LensCapAndInvisibleObstaclesHideThem) {
  const World forest = forest_world(), invisible = forest_world(false);
  StereoCameras capped(forest, paper_rig(), {.lens_cap = true, .noise_gray = 2}, {1, 1});
  const StereoFrame dark = capped.capture(body_at({0, 0, 3}, level), 0);
  double maximum = 0;
  cv::minMaxLoc(dark.left, nullptr, &maximum);
  EXPECT_LT(maximum, 15);
  EXPECT_GT(cv::norm(dark.left, cv::NORM_L1), 0) << "noise still applies";

  StereoCameras seeing(forest, paper_rig(), noiseless(), {1, 1}),
      blind(invisible, paper_rig(), noiseless(), {1, 1});
  const cv::Mat near_trees = seeing.depth(body_at({0, 0, 3}, level))(cv::Rect(0, 0, 376, 100));
  const cv::Mat sky_only = blind.depth(body_at({0, 0, 3}, level))(cv::Rect(0, 0, 376, 100));
  double nearest = 0, nearest_blind = 0;
  cv::minMaxLoc(near_trees, &nearest);
  cv::minMaxLoc(sky_only, &nearest_blind);
  EXPECT_LT(nearest, 6.0);
  EXPECT_GT(nearest_blind, 100.0);
}

TEST(StereoCameras, ChaseViewLeavesTheStereoPairAsItWas) {
  const World world = forest_world();
  const Eigen::Isometry3d body = body_at({0, 0, 3}, level);
  StereoCameras cameras(world, paper_rig(), noiseless(), {1, 1});
  const StereoFrame before = cameras.capture(body, 0);
  const cv::Mat view = cameras.chase_view({.T_world_body = body}, 500, 300);
  EXPECT_EQ(view.size(), cv::Size(500, 300));
  EXPECT_EQ(view.type(), CV_8UC3);
  const StereoFrame after = cameras.capture(body, 1);
  EXPECT_TRUE(equal(before.left, after.left) && equal(before.right, after.right));
}

TEST(StereoCameras, TwoPairsTakeTurnsOnOneThread) {
  const World forest = forest_world(), invisible = forest_world(false);
  const Eigen::Isometry3d body = body_at({0, 0, 3}, level);
  StereoCameras first(forest, paper_rig(), noiseless(), {1, 1});
  const StereoFrame alone = first.capture(body, 0);
  StereoCameras second(invisible, paper_rig(), noiseless(), {1, 1});
  EXPECT_FALSE(equal(alone.left, second.capture(body, 0).left));
  EXPECT_TRUE(equal(alone.left, first.capture(body, 1).left));
}

TEST(StereoCameras, MissingLibraryIsOneLineThatNamesThePackage) {
  const World world = bare_world("");
  setenv("UNDERSTORY_OSMESA", "/proc/nowhere/libOSMesa.so", 1);
  std::string message;
  try {
    StereoCameras cameras(world, paper_rig(), noiseless(), {1, 1});
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  unsetenv("UNDERSTORY_OSMESA");
  EXPECT_NE(message.find("libosmesa6"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace understory
