
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "scenarios/report/pictures.hpp"

namespace understory {
namespace {

StereoRig rig() {
  StereoRig rig;
  rig.focal_px = 200;
  rig.baseline_m = 0.35;
  rig.center_left_x_px = 188;
  rig.center_right_x_px = 188;
  rig.center_y_px = 120;
  return rig;
}

bool is_red(const cv::Vec3b& pixel) { return pixel[2] > 200 && pixel[0] < 60 && pixel[1] < 60; }

TEST(Overlay, ARememberedPointIsDrawnWhereThePinholeSaysAndBoxesWhereTheHitsAre) {
  OverlayMoment moment;
  moment.left = cv::Mat(240, 376, CV_8UC1, cv::Scalar(128));
  moment.T_world_camera = Eigen::Isometry3d::Identity();
  moment.T_world_camera.translation().z() = -1;
  ObstaclePoint point;
  point.position_world = {1.0, -0.5, 4.0};  // 5 m ahead of the camera: u = 188 + 40, v = 120 - 20
  moment.remembered = {point};
  StereoHit hit;
  hit.column_px = 300;
  hit.row_px = 50;
  moment.hits = {hit};
  const cv::Mat picture = draw_overlay(moment, rig(), 2);
  ASSERT_EQ(picture.size(), cv::Size(752, 480));
  EXPECT_TRUE(is_red(picture.at<cv::Vec3b>(2 * 100 + 1, 2 * 228 + 1)));
  EXPECT_FALSE(is_red(picture.at<cv::Vec3b>(2 * 100 + 1, 2 * 240 + 1)));
  EXPECT_GT(picture.at<cv::Vec3b>(100, 605)[0], 200);  // the box's upper edge, blue
  EXPECT_LT(picture.at<cv::Vec3b>(100, 605)[2], 60);
}

TEST(Video, CanBeReadBackFrameByFrame) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "understory_video.mp4";
  std::filesystem::remove(file);
  VideoFile video(file, 30);
  for (int i = 0; i < 12; ++i) video.add(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(20 * i)));
  EXPECT_FALSE(std::filesystem::exists(file));  // not before it is whole
  video.finish();
  cv::VideoCapture capture(file.string());
  ASSERT_TRUE(capture.isOpened());
  int count = 0;
  for (cv::Mat picture; capture.read(picture); ++count) EXPECT_NEAR(cv::mean(picture)[0], 20 * count, 6);
  EXPECT_EQ(count, 12);
}

}  // namespace
}  // namespace understory
