#include "perception/full_stereo/full_stereo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/perception/rigs.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace understory {
namespace {

support::SyntheticPlane plane_at(double depth_m) {
  return {.depth_m = depth_m, .grain_px = 3, .coarse_contrast = 60, .noise_gray_levels = 0};
}

/// The two matchers under one roof.
struct Matcher {
  const char* name;
  FullStereoDetector (*detector)(const StereoRig&, const FullStereoCrop&);
};

template <typename Config>
FullStereoDetector detector_with(const StereoRig& rig, const FullStereoCrop& crop) {
  return FullStereoDetector(rig, Config{}, crop);
}

const Matcher matchers[] = {{"bm", detector_with<StereoBmConfig>}, {"sgbm", detector_with<StereoSgbmConfig>}};

class FullStereoOf : public testing::TestWithParam<std::tuple<Matcher, const char*>> {
 protected:
  const Matcher& matcher() const { return std::get<0>(GetParam()); }
  StereoRig rig() const { return support::house_rig(std::get<1>(GetParam())); }
};

/// Parallax found, less that of the plane looked at, of the matched pixels between two columns.
struct ParallaxErrors {
  std::vector<double> px;
  int pixels = 0;
  double median_px() {
    std::sort(px.begin(), px.end());
    return px[px.size() / 2];
  }
  double share() const { return static_cast<double>(px.size()) / pixels; }
};

ParallaxErrors errors_of(const StereoRig& rig, const cv::Mat& depth_m, double plane_m, int from_px,
                         int to_px) {
  ParallaxErrors errors;
  for (int v = 2; v < rig.height_px - 2; ++v) {
    for (int u = from_px; u < to_px; ++u) {
      ++errors.pixels;
      const double z_m = depth_m.at<float>(v, u);
      if (z_m > 0) errors.px.push_back(rig.focal_px * rig.baseline_m * (1 / z_m - 1 / plane_m));
    }
  }
  return errors;
}

TEST_P(FullStereoOf, PutsAPlaneWhereItIsWhereverBothEyesSeeIt) {
  FullStereoDetector stereo = matcher().detector(rig(), {});
  // Of the search: whole disparities are exact, and between them OpenCV's parabola leans to the nearer.
  for (const double disparity_px : {8.0, 13.0, 40.0, 8.4, 12.7, 21.25}) {
    const double infinity_px = rig().infinity_disparity_px();
    const double parallax_px = disparity_px + std::round(infinity_px) - infinity_px;
    const double tolerance_px = disparity_px == std::round(disparity_px) ? 1.01 / 16 : 0.4;
    const double plane_m = rig().focal_px * rig().baseline_m / parallax_px;
    stereo.detect(support::render_plane(rig(), plane_at(plane_m)));
    const cv::Mat& depth_m = stereo.depth_m();
    // Half a window off the right image's first column; the same off the left image's last.
    const int first_px = static_cast<int>(std::ceil(rig().disparity_px(plane_m))) + 2;
    const int last_px = rig().width_px - 2;
    for (int from_px = first_px; from_px + 20 <= last_px; from_px += 20) {
      ParallaxErrors errors = errors_of(rig(), depth_m, plane_m, from_px, from_px + 20);
      EXPECT_GT(errors.share(), 0.5) << disparity_px << " px, column " << from_px;
      EXPECT_NEAR(errors.median_px(), 0, tolerance_px) << disparity_px << " px, column " << from_px;
    }
    // What lies off the right image at any depth stays unmatched.
    EXPECT_EQ(cv::countNonZero(depth_m.colRange(0, static_cast<int>(std::round(infinity_px)) + 2)), 0);
  }
}

TEST_P(FullStereoOf, SeesAPlaneInsideItsCropAndNoneOutside) {
  const FullStereoCrop crop = one_pixel_crop(rig());
  FullStereoDetector detector = matcher().detector(rig(), crop);
  const auto disparity_px = std::round(rig().disparity_px(rig().detection_depth_m));
  for (const double away_px : {-0.5, 0.0, 0.5}) {
    const double depth_m = rig().depth_m(disparity_px + away_px);
    const auto hits = detector.detect(support::render_plane(rig(), plane_at(depth_m)));
    ASSERT_GT(hits.size(), 1000u);
    for (const StereoHit& hit : hits) {
      EXPECT_GE(hit.position_camera.z(), crop.minimum_depth_m);
      EXPECT_LE(hit.position_camera.z(), crop.maximum_depth_m);
    }
  }
  for (const double away_px : {-3.0, 3.0}) {
    const double depth_m = rig().depth_m(disparity_px + away_px);
    EXPECT_LT(detector.detect(support::render_plane(rig(), plane_at(depth_m))).size(), 20u);
  }
}

TEST_P(FullStereoOf, HitsLieOnThePlaneInsideTheirDepthInterval) {
  FullStereoDetector detector = matcher().detector(rig(), {});
  const double depth_m = 6.3;
  std::size_t inside = 0;
  const auto hits = detector.detect(support::render_plane(rig(), plane_at(depth_m)));
  for (const StereoHit& hit : hits) {
    inside += hit.depth.near_m <= depth_m && depth_m <= hit.depth.far_m ? 1u : 0u;
    const Eigen::Vector3d ray = hit.position_camera / hit.position_camera.z();
    EXPECT_NEAR(ray.x() * rig().focal_px + rig().center_left_x_px, hit.column_px + 2, 1e-9);
    EXPECT_NEAR(ray.y() * rig().focal_px + rig().center_y_px, hit.row_px + 2, 1e-9);
    EXPECT_NEAR(hit.disparity_px, rig().disparity_px(hit.position_camera.z()), 1e-9);
    EXPECT_LE(hit.row_px, FullStereoCrop{}.last_row_px);
    EXPECT_LE(hit.position_camera.y(), FullStereoCrop{}.maximum_below_m);
  }
  ASSERT_GT(hits.size(), 1000u);
  EXPECT_GT(static_cast<double>(inside), 0.95 * static_cast<double>(hits.size()));
}

TEST_P(FullStereoOf, SaysTheSameAgain) {
  const StereoFrame frame = support::render_plane(rig(), plane_at(7));
  FullStereoDetector one = matcher().detector(rig(), {}), other = matcher().detector(rig(), {});
  one.detect(support::render_plane(rig(), plane_at(3)));  // leaves nothing behind
  one.detect(frame);
  other.detect(frame);
  EXPECT_EQ(cv::norm(one.depth_m(), other.depth_m(), cv::NORM_INF), 0);
}

INSTANTIATE_TEST_SUITE_P(Rigs, FullStereoOf,
                         testing::Combine(testing::ValuesIn(matchers),
                                          testing::Values("paper.yaml", "long.yaml")),
                         [](const auto& each) {
                           return std::string(std::get<0>(each.param).name) + "_" +
                                  std::string(std::get<1>(each.param)).substr(0, 4);
                         });

TEST(FullStereo, CellsNeedEnoughPixelsAtTheWantedDepths) {
  const StereoRig rig = support::house_rig("long.yaml");
  const StereoFrame frame = support::render_plane(rig, plane_at(6));
  FullStereoCrop all;
  FullStereoCrop none = all;
  none.minimum_pixels_per_cell = 26;
  EXPECT_GT(FullStereoDetector(rig, StereoBmConfig{}, all).detect(frame).size(), 1000u);
  EXPECT_EQ(FullStereoDetector(rig, StereoBmConfig{}, none).detect(frame).size(), 0u);
}

TEST(FullStereo, OnePixelCropIsThePushbroomsInterval) {
  // The paper's rig: 63.68 m px; its detection disparity 105 px is 13.2 px of parallax, 4.82 m.
  const FullStereoCrop paper = one_pixel_crop(support::house_rig("paper.yaml"));
  EXPECT_NEAR(paper.minimum_depth_m, 180.4 * 0.353 / 14.2, 1e-9);
  EXPECT_NEAR(paper.maximum_depth_m, 180.4 * 0.353 / 12.2, 1e-9);
}

}  // namespace
}  // namespace understory
