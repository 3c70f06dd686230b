#include "scenarios/detect/rig_figures.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/imgproc.hpp>

namespace understory {
namespace {

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

/// Share of clearly green pixels in a row of the picture.
double green_share(const cv::Mat& picture, int row_px) {
  int count = 0;
  for (int u = 0; u < 880; ++u) {  // the view from above
    const cv::Vec3b color = picture.at<cv::Vec3b>(row_px, u);
    count += color[1] > color[0] + 20 && color[1] > color[2] + 20;
  }
  return count / 880.0;
}

/// The band is there, between white-to-gray above and below, and wider in metres where a pixel means more.
TEST(RigPicture, ShowsTheDetectionSurface) {
  StereoRig rig = right_angle_rig();
  const auto band_px = [&] {
    const cv::Mat picture = draw_rig(rig, rig_figures(rig, PushbroomConfig()));
    EXPECT_EQ(picture.size(), cv::Size(1280, 860));
    EXPECT_EQ(picture.type(), CV_8UC3);
    int rows = 0;
    for (int v = 0; v < picture.rows; ++v) rows += green_share(picture, v) > 0.4;
    return rows;
  };
  const int near_px = band_px();
  rig.detection_depth_m = 20;  // 5 px: one pixel is a fifth of the depth to either side
  const int far_px = band_px();
  EXPECT_GT(near_px, 20);
  EXPECT_GT(far_px, 2 * near_px);
}

}  // namespace
}  // namespace understory
