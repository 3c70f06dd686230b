#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "perception/full_stereo/full_stereo.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "tests/sim/camera_scenes.hpp"

/// Raw images of the two real rigs and of fisheye lenses: rendered by undoing the distortion, checked by
/// OpenCV's projection (which distorts), by the stack's own rectification and by its detector.
namespace understory {
namespace {

struct Cameras {
  const char* file;
  std::optional<double> unit_m;
  double depth_m;
};

class RawImages : public testing::TestWithParam<Cameras> {
 protected:
  /// Mounted to look along body x once rectified.
  static CalibratedRig calibrated() {
    CalibrationOptions options;
    options.meters_per_unit = GetParam().unit_m;
    options.detection_depth_m = GetParam().depth_m;
    CalibratedRig read =
        read_calibrated_rig(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / GetParam().file, options);
    Eigen::Matrix3d rectified_of_raw;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) rectified_of_raw(i, j) = read.calibration->left.rectification(i, j);
    read.calibration->T_body_left = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
    read.calibration->T_body_left.linear() *= rectified_of_raw;
    read.rig = rectified_rig(*read.calibration, GetParam().depth_m);
    return read;
  }
};

/// By the calibration alone: from rectified camera coordinates of the eye into its raw image.
cv::Point2d raw_pixel(const CameraCalibration& camera, const Eigen::Vector3d& point_rectified) {
  const cv::Vec3d point_raw =
      camera.rectification.t() * cv::Vec3d(point_rectified.x(), point_rectified.y(), point_rectified.z());
  std::vector<cv::Point2d> pixels;
  const std::vector<cv::Point3d> points{cv::Point3d(point_raw)};
  if (camera.lens == LensModel::equidistant)
    cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), camera.camera_matrix,
                               camera.distortion);
  else
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), camera.camera_matrix, camera.distortion, pixels);
  return pixels.front();
}

TEST_P(RawImages, AKnownPointLandsWhereTheCalibrationPutsIt) {
  const CalibratedRig cameras = calibrated();
  const World nothing = bare_world("");
  StereoCameras skyward(nothing, cameras.rig, noiseless(), {1, 1}, cameras.calibration);
  const StereoFrame sky = skyward.capture(body_at({0, 0, 0}, level), 0);
  int seen = 0;
  for (const double across : {-0.30, 0.02, 0.35})
    for (const double down : {-0.2, 0.15}) {
      const Eigen::Vector3d left(across * 6, down * 6, 6);  // rectified left camera: x right, y down, z ahead
      const Eigen::Vector3d right = left - Eigen::Vector3d(cameras.rig.baseline_m, 0, 0);
      const World world = black_ball({left.z(), -left.x(), -left.y()}, 0.15);
      StereoCameras eyes(world, cameras.rig, noiseless(), {1, 1}, cameras.calibration);
      const StereoFrame frame = eyes.capture(body_at({0, 0, 0}, level), 0);
      const auto expect_at = [&](const cv::Mat& image, const cv::Mat& empty, const cv::Point2d& expected) {
        if (!cv::Rect2d(10, 10, image.cols - 20, image.rows - 20).contains(expected)) return;
        const Eigen::Vector2d at = shade(image, empty).mean_px;
        EXPECT_NEAR(at.x(), expected.x, 0.2) << across << ", " << down;
        EXPECT_NEAR(at.y(), expected.y, 0.2) << across << ", " << down;
        ++seen;
      };
      expect_at(frame.left, sky.left, raw_pixel(cameras.calibration->left, left));
      expect_at(frame.right, sky.right, raw_pixel(cameras.calibration->right, right));
    }
  EXPECT_GE(seen, 8);
}

TEST_P(RawImages, RectifiedTheyAreTheIdealPair) {
  const CalibratedRig cameras = calibrated();
  const World world = forest_world();
  const Eigen::Isometry3d body = body_at({-4, 0.4, 3}, level);
  StereoCameras raw_eyes(world, cameras.rig, noiseless(), {1, 1}, cameras.calibration);
  StereoCameras ideal_eyes(world, cameras.rig, noiseless(), {1, 1});
  const StereoFrame ideal = ideal_eyes.capture(body, 0);
  Rectifier rectifier(*cameras.calibration, Interpolation::bilinear);
  const StereoFrame raw = raw_eyes.capture(body, 0);
  const StereoFrame rectified = rectifier.rectify(raw);
  // Where the raw camera looks at all: a white image, rectified.
  Rectifier whites(*cameras.calibration, Interpolation::bilinear);
  const cv::Mat white(raw.left.size(), CV_8UC1, cv::Scalar(255));
  const StereoFrame covered = whites.rectify({0, white, white});
  const auto difference = [](const cv::Mat& a, const cv::Mat& b, const cv::Mat& cover) {
    cv::Mat gap;
    cv::absdiff(a, b, gap);
    return cv::mean(gap, cover > 250)[0];
  };
  EXPECT_GT(cv::countNonZero(covered.left > 250), 0.8 * double(white.total()));
  EXPECT_LT(difference(rectified.left, ideal.left, covered.left), 5);
  EXPECT_LT(difference(rectified.right, ideal.right, covered.right), 5);
  // One pixel of error either way would be worse: the difference is smallest at no shift.
  const cv::Rect middle(40, 40, 290, 150);
  for (const cv::Point shift : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)})
    EXPECT_LT(cv::norm(rectified.right(middle), ideal.right(middle), cv::NORM_L1),
              cv::norm(rectified.right(middle), ideal.right(middle + shift), cv::NORM_L1));
}

TEST_P(RawImages, TheDetectorFindsAWallAtItsDepthInThem) {
  const CalibratedRig cameras = calibrated();
  PushbroomStereo detector(cameras, robust_pushbroom());
  const World world = forest_world(false);
  // Straight down from the detection depth onto the textured ground.
  StereoCameras eyes(world, cameras.rig, {.noise_gray = 2}, {1, 1}, cameras.calibration);
  const StereoFrame frame = eyes.capture(body_at({10, 0, detector.detection_depth_m()}, straight_down), 0);
  const auto hits = detector.detect(frame);
  EXPECT_GT(hits.size(), 300u);
  const World above = forest_world(false);
  EXPECT_LT(detector.detect(eyes.capture(body_at({10, 0, 2 * GetParam().depth_m}, straight_down), 0)).size(),
            hits.size() / 10);
}

TEST_P(RawImages, DetectorsThatKnowNoRawPairsGetRectifiedOnes) {
  const CalibratedRig cameras = calibrated();
  const World world = forest_world();
  StereoCameras eyes(world, cameras.rig, noiseless(), {1, 1}, cameras.calibration);
  const StereoFrame frame = eyes.capture(body_at({-4, 0.4, 3}, level), 0);
  RectifyingDetector detector(*cameras.calibration, std::make_unique<FullStereoDetector>(
                                                        cameras.rig, StereoBmConfig{}, FullStereoCrop{}));
  const auto hits = detector.detect(frame);
  FullStereoDetector plain(cameras.rig, StereoBmConfig{}, FullStereoCrop{});
  Rectifier rectifier(*cameras.calibration, Interpolation::nearest);
  const auto expected = plain.detect(rectifier.rectify(frame));
  ASSERT_EQ(hits.size(), expected.size());
  EXPECT_GT(hits.size(), 0u);
  for (std::size_t i = 0; i < hits.size(); ++i)
    EXPECT_EQ(hits[i].position_camera, expected[i].position_camera);
}

INSTANTIATE_TEST_SUITE_P(Rigs, RawImages,
                         testing::Values(Cameras{"models/rigs/raw/paper.xml", 0.01, 4.8},
                                         Cameras{"models/rigs/raw/long.xml", 1, 10.1},
                                         Cameras{"tests/data/fisheye_camchain.yaml", {}, 2.5}),
                         [](const auto& rig) {
                           return std::filesystem::path(rig.param.file).stem().string();
                         });

TEST(RawMisalignment, IsInTheRawImagesOwnPixels) {
  CalibrationOptions options;
  const CalibratedRig cameras =
      read_calibrated_rig(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models/rigs/raw/long.xml", options);
  const World world = black_ball({6, 0, 0}, 0.3);
  const auto right = [&](double px) {
    CameraConfig config = noiseless();
    config.vertical_misalignment_px = px;
    StereoCameras eyes(world, cameras.rig, config, {1, 1}, cameras.calibration);
    const StereoFrame frame = eyes.capture(body_at({0, 0, 0}, level), 0);
    return dark_centroid(frame.right(cv::Rect(80, 30, 220, 170)));
  };
  EXPECT_NEAR(right(3).y() - right(0).y(), 3, 0.1);
}

}  // namespace
}  // namespace understory
