#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/detect/posed_map.hpp"
#include "scenarios/detect/rig_figures.hpp"
#include "scenarios/report/pictures.hpp"
#include "tests/support/temporary_folder.hpp"

/// What `detect` and `rig` say and draw.
namespace understory {
namespace {

namespace fs = std::filesystem;

/// Half its width is the focal length: a field of view of 90 degrees, by construction.
StereoRig right_angle_rig() {
  StereoRig rig;
  rig.name = "right angle";
  rig.width_px = 400;
  rig.height_px = 300;
  rig.focal_px = 200;
  rig.baseline_m = 0.5;
  rig.center_left_x_px = rig.center_right_x_px = 199.5;
  rig.center_y_px = 149.5;
  rig.detection_depth_m = 5.1;  // 19.6 px; the nearest whole disparity, 20 px, lies at 5 m
  return rig;
}

TEST(RigFigures, AgreeWithClosedForms) {
  const RigFigures figures = rig_figures(right_angle_rig(), PushbroomConfig());
  EXPECT_NEAR(figures.left_field_of_view_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(figures.right_field_of_view_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(figures.vertical_field_of_view_rad, 2 * std::atan(150.0 / 200), 1e-12);
  EXPECT_EQ(figures.detection_disparity_px, 20);
  EXPECT_NEAR(figures.detection_depth_m, 5, 1e-12);
  EXPECT_NEAR(figures.one_pixel.near_m, 100.0 / 21, 1e-12);
  EXPECT_NEAR(figures.one_pixel.far_m, 100.0 / 19, 1e-12);
  EXPECT_EQ(figures.window_first_px, -3);
  EXPECT_EQ(figures.window_last_px, 3);
  EXPECT_EQ(column_text(figures.window_first_px), "u + 3");
  // At 5 m each eye sees 10 m; together they see what the baseline leaves of it, right of the right eye's
  // left.
  EXPECT_EQ(figures.compared_columns_px, 380);
  EXPECT_NEAR(figures.surface_left_m, -4.5, 1e-12);
  EXPECT_NEAR(figures.surface_right_m, 5, 1e-12);
}

TEST(RigFigures, HoldWhereTheDisparityIsNegative) {
  StereoRig rig = right_angle_rig();
  rig.center_right_x_px += 60;  // infinity at -60 px, detection at -40 px
  const RigFigures figures = rig_figures(rig, PushbroomConfig());
  EXPECT_EQ(figures.detection_disparity_px, -40);
  EXPECT_EQ(figures.compared_columns_px, 360);
  EXPECT_NEAR(figures.surface_left_m, -5, 1e-12);
  EXPECT_NEAR(figures.surface_right_m, 4, 1e-12);
}

TEST(RigPicture, ShowsTheDetectionSurface) {
  StereoRig rig = right_angle_rig();
  const auto plots = [&] { return rig_plots(rig, rig_figures(rig, PushbroomConfig())); };
  const Series interval = plots()[0].series[3];
  EXPECT_NEAR(*std::ranges::min_element(interval.y), 100.0 / 21, 1e-9);  // 20 px lie at 5 m
  EXPECT_NEAR(*std::ranges::max_element(interval.y), 100.0 / 19, 1e-9);
  const Series view = plots()[0].series[0];
  EXPECT_NEAR(view.x[2] - view.x[0], 2 * view.y[0], 0.01 * view.y[0]);  // a right angle
  rig.detection_depth_m = 20;                                           // 5 px
  EXPECT_NEAR(plots()[0].series[2].y[0], 20, 1e-9);
  const Series partner = plots()[1].series[0];
  EXPECT_EQ(partner.x[0] - partner.y[0], 5);
}

/// A camera that looks along world x whatever the body's axes are, moved along x at 1 m/s.
TEST(PosedMap, ForgetsWhatTheCameraHasPassedWhateverTheBodysAxes) {
  Eigen::Matrix3d looks_along_x;  // camera (right, down, ahead) into world (ahead, left, up)
  looks_along_x << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (const Eigen::Quaterniond& body :
       {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)}) {
    Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
    T_body_camera.linear() = body.toRotationMatrix().transpose() * looks_along_x;
    const auto T_world_camera = [&](double x_m) {
      return Eigen::Translation3d(x_m, 0, 0) * Eigen::Isometry3d(body) * T_body_camera;
    };
    LocalMapConfig config;
    config.passed_m = 1;
    config.max_age_s = 100;
    PosedMap map(config);
    StereoHit hit;
    hit.position_camera = {0.5, -0.25, 3};
    map.insert({hit}, T_world_camera(2), 2'000'000'000);
    ASSERT_EQ(map.points().size(), 1u);
    EXPECT_TRUE(map.points()[0].position_world.isApprox(Eigen::Vector3d(5, -0.5, 0.25), 1e-12));
    map.insert({}, T_world_camera(5.9), 5'900'000'000);
    EXPECT_EQ(map.points().size(), 1u);
    map.insert({}, T_world_camera(6.1), 6'100'000'000);
    EXPECT_EQ(map.points().size(), 0u);
  }
}

TEST(PosedMap, CountsWhatWasFlownBetweenFrames) {
  PosedMap map(LocalMapConfig{});
  StereoHit hit;
  hit.position_camera = {0, 0, 5};
  map.insert({}, Eigen::Isometry3d::Identity(), 0);
  map.insert({hit}, Eigen::Isometry3d(Eigen::Translation3d(1.5, 2, 0)), 5'000'000'000);
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_NEAR(map.points()[0].distance_flown_m, 2.5, 1e-12);
}

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
  const fs::path file = fs::path(testing::TempDir()) / "understory_video.mp4";
  fs::remove(file);
  VideoFile video(file, 30);
  for (int i = 0; i < 12; ++i) video.add(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(20 * i)));
  video.finish();
  cv::VideoCapture capture(file.string());
  ASSERT_TRUE(capture.isOpened());
  int count = 0;
  for (cv::Mat picture; capture.read(picture); ++count) EXPECT_NEAR(cv::mean(picture)[0], 20 * count, 6);
  EXPECT_EQ(count, 12);
}

}  // namespace
}  // namespace understory
