#include "perception/pushbroom/pushbroom_stereo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <tuple>

#include "tests/perception/rigs.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace understory {

bool operator==(const StereoHit& a, const StereoHit& b) {
  return a.position_camera == b.position_camera && a.column_px == b.column_px && a.row_px == b.row_px &&
         a.disparity_px == b.disparity_px && a.score == b.score && a.edge_sum == b.edge_sum;
}

namespace {

using namespace support;

/// Blocks of the detector's grid whose left and right edges suffice: those that could hit at all.
int textured_blocks(const StereoFrame& frame, const PushbroomStereo& detector,
                    const PushbroomConfig& config) {
  cv::Mat left, right;
  cv::Laplacian(frame.left, left, CV_8U, 3);
  cv::Laplacian(frame.right, right, CV_8U, 3);
  const int d = detector.detection_disparity_px();
  int count = 0;
  for (int v = 0; v <= config.last_row_px; v += 5)
    for (int u = d; u + 5 + config.right_margin_px <= left.cols; u += 5)
      count += cv::sum(left(cv::Rect(u, v, 5, 5)))[0] >= config.minimum_edge_sum &&
               cv::sum(right(cv::Rect(u - d, v, 5, 5)))[0] >= config.minimum_edge_sum;
  return count;
}

struct Share {
  int textured = 0;
  int hits = 0;
  double hit() const { return static_cast<double>(hits) / std::max(textured, 1); }
};

/// Over four textures, so that one percent is several blocks.
Share share(const StereoRig& rig, const PushbroomConfig& config, SyntheticPlane plane) {
  PushbroomStereo detector(rig, config);
  Share share;
  for (plane.seed = 1; plane.seed <= 4; ++plane.seed) {
    const StereoFrame frame = render_plane(rig, plane);
    share.textured += textured_blocks(frame, detector, config);
    share.hits += static_cast<int>(detector.detect(frame).size());
  }
  return share;
}

struct Case {
  const char* rig;
  bool robust;
};

void PrintTo(const Case& test, std::ostream* out) {
  *out << test.rig << (test.robust ? " robust" : " original");
}

class OnPlanes : public testing::TestWithParam<Case> {
 protected:
  StereoRig rig = house_rig(GetParam().rig);
  PushbroomConfig config = GetParam().robust ? robust_pushbroom() : original_pushbroom();
};

TEST_P(OnPlanes, HitsAtTheDetectionDistanceAndNowhereElse) {
  const double disparity_px = PushbroomStereo(rig, config).detection_disparity_px();
  // The rig's own distance, and that of the whole disparity: both count as the detection distance.
  for (const double depth_m : {rig.detection_depth_m, rig.depth_m(disparity_px)}) {
    const Share at = share(rig, config, {.depth_m = depth_m});
    EXPECT_GT(at.textured, 1000);
    EXPECT_GE(at.hit(), 0.5) << depth_m;
  }
  for (const double away_px : {-3.0, 3.0}) {
    const Share away = share(rig, config, {.depth_m = rig.depth_m(disparity_px + away_px)});
    EXPECT_GT(away.textured, 500);
    EXPECT_LE(away.hit(), 0.01) << away_px;
  }
}

TEST_P(OnPlanes, RejectsWhatRepeatsAlongTheRow) {
  PushbroomStereo detector(rig, config);
  const int to_infinity_px = detector.detection_disparity_px() - detector.infinity_disparity_px();
  const double depth_m = detector.detection_depth_m();
  for (const int period_px : {to_infinity_px - 1, to_infinity_px, to_infinity_px + 1}) {
    const Share repeating =
        share(rig, config,
              {.depth_m = depth_m, .contrast = 110, .repeats_every_px = static_cast<double>(period_px)});
    EXPECT_GT(repeating.textured, 300);
    // Uniqueness searches no farther than infinity; the invariance filter looks 3 px past it.
    if (period_px <= to_infinity_px || !config.uniqueness) {
      EXPECT_LE(repeating.hit(), 0.01) << period_px;
    }
  }
  const Share aperiodic = share(rig, config, {.depth_m = depth_m});
  EXPECT_GE(aperiodic.hit(), 0.5);
}

TEST_P(OnPlanes, FindsNothingWithoutTexture) {
  PushbroomStereo detector(rig, config);
  EXPECT_TRUE(
      detector.detect(render_plane(rig, {.contrast = 0, .coarse_contrast = 0, .noise_gray_levels = 0}))
          .empty());
  EXPECT_TRUE(detector
                  .detect(render_plane(rig, {.depth_m = detector.detection_depth_m(),
                                             .grain_px = 120,
                                             .coarse_grain_px = 150,
                                             .coarse_contrast = 60}))
                  .empty());
}

TEST_P(OnPlanes, PutsHitsWhereTheRigSees) {
  PushbroomStereo detector(rig, config);
  const auto hits = detector.detect(render_plane(rig, {.depth_m = detector.detection_depth_m()}));
  ASSERT_FALSE(hits.empty());
  for (const StereoHit& hit : hits) {
    const Eigen::Vector3d& p = hit.position_camera;
    const double u_left = rig.focal_px * p.x() / p.z() + rig.center_left_x_px;
    const double u_right = rig.focal_px * (p.x() - rig.baseline_m) / p.z() + rig.center_right_x_px;
    EXPECT_NEAR(u_left, hit.column_px + 2, 1e-9);
    EXPECT_NEAR(u_left - u_right, hit.disparity_px, 1e-9);
    EXPECT_NEAR(rig.focal_px * p.y() / p.z() + rig.center_y_px, hit.row_px + 2, 1e-9);
    EXPECT_LT(hit.score, config.score_limit);
  }
}

INSTANTIATE_TEST_SUITE_P(RigsAndRules, OnPlanes,
                         testing::Values(Case{"paper.yaml", false}, Case{"paper.yaml", true},
                                         Case{"long.yaml", false}, Case{"long.yaml", true}));

TEST(PushbroomStereo, DerivesTheRecordedDepthsFromTheRigs) {
  // Flight records: the paper's rig looks at 4.81 m (4.47 to 5.20), the later one at 10.14 m (9.40 to 11.0).
  // The paper's principal points are printed to a tenth of a pixel, which leaves 0.02 m open.
  const PushbroomStereo paper(house_rig("paper.yaml"), original_pushbroom());
  EXPECT_NEAR(paper.detection_depth_m(), 4.81, 0.02);
  EXPECT_NEAR(paper.one_pixel_interval().near_m, 4.47, 0.02);
  EXPECT_NEAR(paper.one_pixel_interval().far_m, 5.20, 0.03);
  const PushbroomStereo later(house_rig("long.yaml"), original_pushbroom());
  EXPECT_NEAR(later.detection_depth_m(), 10.14, 0.005);
  EXPECT_NEAR(later.one_pixel_interval().near_m, 9.40, 0.005);
  EXPECT_NEAR(later.one_pixel_interval().far_m, 11.0, 0.01);
}

/// A raw pair that shows the plane once rectified: each raw pixel takes the rectified pixel it is seen at.
StereoFrame raw_of(const StereoFrame& rectified, const StereoCalibration& calibration) {
  const auto raw_image = [&](const cv::Mat& image, const CameraCalibration& camera) {
    std::vector<cv::Point2f> pixels, places;
    for (int v = 0; v < image.rows; ++v)
      for (int u = 0; u < image.cols; ++u) pixels.emplace_back(static_cast<float>(u), static_cast<float>(v));
    cv::undistortPoints(pixels, places, camera.camera_matrix, camera.distortion, camera.rectification,
                        camera.projection);
    cv::Mat raw;
    cv::remap(image, raw, cv::Mat(places).reshape(2, image.rows), cv::noArray(), cv::INTER_LINEAR);
    return raw;
  };
  return {rectified.t_ns, raw_image(rectified.left, calibration.left),
          raw_image(rectified.right, calibration.right)};
}

StereoCalibration distorting_calibration(const StereoRig& rig) {
  StereoCalibration calibration{"distorting", rig.width_px, rig.height_px, {}, {}, rig.T_body_camera};
  for (const bool is_left : {true, false}) {
    const double center = is_left ? rig.center_left_x_px : rig.center_right_x_px;
    CameraCalibration camera;
    camera.camera_matrix = {0.9 * rig.focal_px, 0, 188, 0, 0.9 * rig.focal_px, 119, 0, 0, 1};
    camera.distortion = {-0.12, 0.02, 0.001, -0.001};
    cv::Mat turn;
    cv::Rodrigues(cv::Vec3d(0.01, is_left ? 0.02 : -0.02, is_left ? 0.005 : -0.008), turn);
    turn.copyTo(camera.rectification);
    camera.projection =
        support::projection_of(rig.focal_px, center, rig.center_y_px, is_left ? 0 : rig.baseline_m);
    (is_left ? calibration.left : calibration.right) = camera;
  }
  return calibration;
}

// Rectification leaves columns out that no part of the rule looks at, and which those are depends on the rig.
TEST(PushbroomStereo, RawPairsGiveTheHitsOfRectifiedOnesWithAnyNumberOfThreads) {
  for (const char* name : {"long.yaml", "paper.yaml"}) {
    const StereoRig rig = house_rig(name);
    const StereoCalibration calibration = distorting_calibration(rig);
    const double depth_m = PushbroomStereo(rig, {}).detection_depth_m();
    const StereoFrame raw = raw_of(render_plane(rig, {.depth_m = depth_m}), calibration);
    const StereoFrame rectified = Rectifier(calibration, Interpolation::nearest).rectify(raw);
    PushbroomConfig everything = robust_pushbroom();
    everything.horizontal_invariance = everything.subpixel = true;
    everything.depths_m = {depth_m, 0.9 * depth_m};
    for (PushbroomConfig config : {original_pushbroom(), robust_pushbroom(), everything}) {
      config.threads = 1;
      const std::vector<StereoHit> expected = PushbroomStereo(rig, config).detect(rectified);
      EXPECT_GT(expected.size(), 100u);
      for (const int threads : {1, 2, 3, 7}) {
        config.threads = threads;
        EXPECT_EQ(PushbroomStereo(rig, config).detect(rectified), expected);
        PushbroomStereo raw_detector(CalibratedRig{rig, calibration}, config);
        EXPECT_EQ(raw_detector.detect(raw), expected);
        EXPECT_EQ(raw_detector.detect(raw), expected);
      }
    }
  }
}

TEST(PushbroomStereo, SeveralDepthsFindWhatEachWouldFindAlone) {
  const StereoRig rig = house_rig("long.yaml");
  const std::vector<double> depths_m{10.1, 7.0, 5.0};
  for (const double depth_m : depths_m) {
    const StereoFrame frame = render_plane(rig, {.depth_m = depth_m});
    PushbroomConfig config = robust_pushbroom();
    config.isolation = false;
    config.depths_m = depths_m;
    std::vector<StereoHit> together = PushbroomStereo(rig, config).detect(frame), alone;
    for (const double one : depths_m) {
      config.depths_m = {one};
      const std::vector<StereoHit> hits = PushbroomStereo(rig, config).detect(frame);
      alone.insert(alone.end(), hits.begin(), hits.end());
    }
    std::sort(alone.begin(), alone.end(), [](const StereoHit& a, const StereoHit& b) {
      return std::tuple(a.row_px, -a.position_camera.z(), a.column_px) <
             std::tuple(b.row_px, -b.position_camera.z(), b.column_px);
    });
    EXPECT_EQ(together, alone);
    const auto at_depth = std::count_if(together.begin(), together.end(), [&](const StereoHit& hit) {
      return hit.depth.near_m <= depth_m && depth_m <= hit.depth.far_m;
    });
    EXPECT_GT(at_depth, 100);
    EXPECT_GT(static_cast<double>(at_depth), 0.99 * static_cast<double>(together.size()));
  }
}

/// Root mean square of the hits' error in disparity on planes up to half a pixel beside the detection's.
double disparity_error_px(const StereoRig& rig, const PushbroomConfig& config) {
  PushbroomStereo detector(rig, config);
  double squares = 0;
  int count = 0;
  for (const double beside_px : {-0.5, -0.3, -0.1, 0.0, 0.2, 0.4}) {
    const double true_px = detector.detection_disparity_px() + beside_px;
    for (const StereoHit& hit : detector.detect(render_plane(rig, {.depth_m = rig.depth_m(true_px)}))) {
      squares += (hit.disparity_px - true_px) * (hit.disparity_px - true_px);
      ++count;
      EXPECT_NEAR(hit.position_camera.z(), rig.depth_m(hit.disparity_px), 1e-9);
      EXPECT_LE(std::abs(hit.disparity_px - detector.detection_disparity_px()), 0.5);
    }
  }
  EXPECT_GT(count, 1000);
  return std::sqrt(squares / count);
}

TEST(PushbroomStereo, AParabolaTakesAThirdOfTheErrorInDisparityAway) {
  for (const char* name : {"paper.yaml", "long.yaml"})
    for (PushbroomConfig config : {original_pushbroom(), robust_pushbroom()}) {
      const double whole_px = disparity_error_px(house_rig(name), config);
      config.subpixel = true;
      const double parabola_px = disparity_error_px(house_rig(name), config);
      EXPECT_LT(parabola_px, 0.65 * whole_px) << name << ": " << whole_px << " px to " << parabola_px;
    }
}

TEST(PushbroomStereo, EachDepthHasItsOwnThresholdsWhereTheyAreGiven) {
  const StereoRig rig = house_rig("long.yaml");
  const StereoFrame frame = render_plane(rig, {.depth_m = 7});
  PushbroomConfig config = robust_pushbroom();
  config.isolation = false;
  config.depths_m = {10.1, 7.0};
  const auto hits_at_7 = [&](const PushbroomConfig& some) {
    PushbroomStereo detector(rig, some);
    const auto& hits = detector.detect(frame);
    return std::count_if(hits.begin(), hits.end(), [&](const StereoHit& hit) {
      return hit.position_camera.z() == detector.detection_depth_m(1);
    });
  };
  const auto all = hits_at_7(config);
  EXPECT_GT(all, 100);
  config.depths_score_limit = {0.25, 0.02};
  EXPECT_LT(hits_at_7(config), all);
  config.depths_score_limit = {0.02, 0.25};
  config.depths_minimum_edge_sum = {6375, 215};
  EXPECT_EQ(hits_at_7(config), all);
  config.depths_minimum_edge_sum = {215};
  EXPECT_THROW(PushbroomStereo(rig, config), std::logic_error);
}

// Of images of 480 rows, the rows looked at are twice as many as of 240; with those alone they would end
// early.
TEST(PushbroomStereo, LooksAsFarDownTallerImages) {
  StereoRig rig = house_rig("long.yaml");
  rig.height_px = 480;
  rig.center_y_px = 240;
  for (const auto& [config, last_row_px] :
       {std::pair(original_pushbroom(), 400), std::pair(robust_pushbroom(), 410)}) {
    PushbroomStereo detector(rig, config);
    int lowest_px = 0;
    for (const StereoHit& hit : detector.detect(render_plane(rig, {.depth_m = detector.detection_depth_m()})))
      lowest_px = std::max(lowest_px, hit.row_px);
    EXPECT_EQ(lowest_px, last_row_px);
  }
}

TEST(PushbroomStereo, RefusesRulesThatCannotBeMeant) {
  const StereoRig rig = house_rig("long.yaml");
  const auto expect_fault = [&](const std::string& fault, const auto& change) {
    PushbroomConfig config = robust_pushbroom();
    change(config);
    EXPECT_EQ(fault_of(config, rig), fault);
    EXPECT_THROW(PushbroomStereo(rig, config), std::invalid_argument);
  };
  EXPECT_EQ(fault_of(robust_pushbroom(), rig), "");
  for (const int threads : {0, -1, 65})
    expect_fault("threads: must be from 1 to 64, is " + std::to_string(threads),
                 [&](PushbroomConfig& config) { config.threads = threads; });
  expect_fault("score_limit: must be from 0 to 10, is nan",
               [](PushbroomConfig& config) { config.score_limit = std::nan(""); });
  expect_fault("depths_m: the rig long cannot look at 900 m", [](PushbroomConfig& config) {
    config.depths_m = {10, 900};
  });
  expect_fault("depths_m: must be from 0.1 to 1000, is -1",
               [](PushbroomConfig& config) { config.depths_m = {-1}; });
  expect_fault("disparities_px: the rig long cannot look at -20 px (u_right - u_left)",
               [](PushbroomConfig& config) {
                 config.disparities_px = {-30, -20};
               });
  expect_fault("disparities_px and depths_m exclude each other: name one of them",
               [](PushbroomConfig& config) {
                 config.depths_m = {10};
                 config.disparities_px = {-30};
               });
}

// The two pairs of numbers in the configuration files of the original (docs/sources.md [2]): of the paper's
// rig, and of a later one whose infinity lies on the other side.
TEST(PushbroomStereo, TakesTheOriginalsNumbersAsItsFilesStateThem) {
  StereoRig later = house_rig("paper.yaml");
  later.focal_px = 320;
  later.baseline_m = 0.33;
  later.center_left_x_px = 174;
  later.center_right_x_px = 190.5;
  const StereoRig paper = house_rig("paper.yaml");
  const struct {
    StereoRig rig;
    int disparity_px, infinity_px;
    double depth_m;
  } cases[] = {
      // focal length times baseline over the parallax: 180.4 * 0.353 / (105 - 91.8), 320 * 0.33 / (-6 + 16.5)
      {paper, -105, -95,
       paper.focal_px * paper.baseline_m / (105 - (paper.center_left_x_px - paper.center_right_x_px))},
      {later, 6, 16, 10.06}};
  for (const auto& one : cases) {
    PushbroomConfig config = original_pushbroom();
    config.disparities_px = {one.disparity_px};
    config.infinity_px = one.infinity_px;
    const PushbroomStereo detector(one.rig, config);
    EXPECT_EQ(detector.detection_disparity_px(), -one.disparity_px);
    EXPECT_EQ(detector.infinity_disparity_px(), -one.infinity_px);
    EXPECT_NEAR(one.rig.depth_m(detector.detection_disparity_px()), one.depth_m, 0.01);
  }
}

TEST(PushbroomStereo, RefusesImagesOfAnotherSizeOrKind) {
  const StereoRig rig = house_rig("paper.yaml");
  PushbroomStereo detector(rig, original_pushbroom());
  const cv::Mat right_size(240, 376, CV_8UC1, cv::Scalar(0)), small(120, 188, CV_8UC1, cv::Scalar(0));
  EXPECT_THROW(detector.detect({0, right_size, small}), std::logic_error);
  EXPECT_THROW(detector.detect({0, cv::Mat(240, 376, CV_8UC3, cv::Scalar()), right_size}), std::logic_error);
  EXPECT_TRUE(detector.detect({0, right_size, right_size}).empty());
}

TEST(PushbroomStereo, OfEachCellTheBestIsKept) {
  const CalibratedRig rig{house_rig("paper.yaml"), {}};
  std::mt19937 generator(5);
  cv::Mat left(240, 376, CV_8UC1), right(240, 376, CV_8UC1, cv::Scalar(0));
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 376; ++u) left.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(generator() % 256);
  PushbroomConfig config = original_pushbroom();
  config.horizontal_invariance = false;
  config.stride_px = 2;
  config.depths_m = {4.8, 3};
  const auto hits_of = [&](int cell_px) {
    config.cell_px = cell_px;
    PushbroomStereo detector(rig.rig, config);
    // The upper half of the scene stands at the first depth, the lower at the second; noise tells scores
    // apart.
    for (int depth : {0, 1}) {
      const int disparity_px = detector.detection_disparity_px(depth);
      for (int v = 120 * depth; v < 120 * depth + 120; ++v)
        for (int u = disparity_px; u < 376; ++u)
          right.at<std::uint8_t>(v, u - disparity_px) =
              static_cast<std::uint8_t>(left.at<std::uint8_t>(v, u) ^ ((u + v) % 7));
    }
    return std::vector<StereoHit>(detector.detect({0, left, right}));
  };
  const std::vector<StereoHit> all = hits_of(0), kept = hits_of(7);
  std::map<std::tuple<int, int, double>, const StereoHit*> best;
  for (const StereoHit& hit : all) {
    const StereoHit*& one = best[{(hit.row_px + 2) / 7, (hit.column_px + 2) / 7, hit.disparity_px}];
    if (one == nullptr || hit.score < one->score) one = &hit;
  }
  ASSERT_EQ(kept.size(), best.size());
  EXPECT_LT(kept.size(), all.size() / 5);
  const StereoHit* before = nullptr;
  for (const StereoHit& hit : kept) {
    const StereoHit* one = best[{(hit.row_px + 2) / 7, (hit.column_px + 2) / 7, hit.disparity_px}];
    EXPECT_EQ(std::pair(hit.column_px, hit.row_px), std::pair(one->column_px, one->row_px));
    EXPECT_LT(before, one);  // the order stays
    before = one;
  }
}

TEST(Isolation, KeepsExactlyTheHitsWithCompany) {
  std::vector<StereoHit> hits(6);
  const double x[] = {0.0, 0.9, 5.0,
                      1.7, 5.5, 9.0};  // 0.0 has one other within 1 m, 0.9 two, 1.7 one, 5.0 one
  for (std::size_t i = 0; i < 6; ++i) hits[i].position_camera = {x[i], 0, 10};
  const auto kept = [&](int minimum_points) {
    std::vector<StereoHit> some;
    without_isolated(hits, minimum_points, 1.0, some);
    return some;
  };
  ASSERT_EQ(kept(3).size(), 1u);
  EXPECT_DOUBLE_EQ(kept(3)[0].position_camera.x(), 0.9);
  EXPECT_EQ(kept(2).size(), 5u);
  EXPECT_EQ(kept(1).size(), 6u);
  hits.clear();
  EXPECT_TRUE(kept(3).empty());
}

}  // namespace
}  // namespace understory
