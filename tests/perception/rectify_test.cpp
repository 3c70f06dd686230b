#include "perception/rectify.hpp"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/support/instruction_sets.hpp"

namespace understory {
namespace {

StereoCalibration calibration(int width_px, int height_px, double distortion, double turn_rad) {
  StereoCalibration calibration;
  calibration.name = "test";
  calibration.width_px = width_px;
  calibration.height_px = height_px;
  for (const double side : {-1.0, 1.0}) {
    CameraCalibration camera;
    camera.camera_matrix = {
        0.85 * width_px, 0, 0.52 * width_px, 0, 0.86 * width_px, 0.47 * height_px, 0, 0, 1};
    camera.distortion = {-0.35 * distortion, 0.12 * distortion, 0.001, -0.0007, 0.02, 0.01, 0.004, 0.0};
    cv::Mat rotation;
    cv::Rodrigues(cv::Vec3d(0.02, 0.03 * side, side * turn_rad), rotation);
    rotation.copyTo(camera.rectification);
    camera.projection = {0.95 * width_px,
                         0,
                         0.5 * width_px,
                         side > 0 ? -0.3 * width_px : 0,
                         0,
                         0.95 * width_px,
                         0.5 * height_px,
                         0,
                         0,
                         0,
                         1,
                         0};
    (side < 0 ? calibration.left : calibration.right) = camera;
  }
  return calibration;
}

cv::Mat noise(int width_px, int height_px, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  cv::Mat image(height_px, width_px, CV_8UC1);
  for (auto it = image.begin<std::uint8_t>(); it != image.end<std::uint8_t>(); ++it)
    *it = static_cast<std::uint8_t>(generator() >> 56);
  return image;
}

cv::Mat remapped(const CameraCalibration& camera, const cv::Mat& raw, int interpolation) {
  cv::Mat u, v, image;
  cv::initUndistortRectifyMap(camera.camera_matrix, camera.distortion, camera.rectification,
                              camera.projection, raw.size(), CV_32FC1, u, v);
  cv::Mat places, fractions;
  cv::convertMaps(u, v, places, fractions, CV_16SC2, interpolation == cv::INTER_NEAREST);
  cv::remap(raw, image, places, fractions, interpolation, cv::BORDER_CONSTANT);
  return image;
}

TEST(Rectifier, EqualsOpenCvsRemapBitForBitOnEveryInstructionSet) {
  // From no distortion to a picture turned half way round with its corners outside the source.
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{376, 240}, {32, 9}, {33, 5}, {752, 480}, {31, 9}, {9, 9}})
    for (const double distortion : {0.0, 1.0, -2.0})
      for (const double turn_rad : {0.0, 0.01, 0.4, 1.6}) {
        const StereoCalibration rig = calibration(width, height, distortion, turn_rad);
        for (const auto interpolation : {Interpolation::nearest, Interpolation::bilinear}) {
          Rectifier rectifier(rig, interpolation);
          const int flag = interpolation == Interpolation::nearest ? cv::INTER_NEAREST : cv::INTER_LINEAR;
          for (const std::uint64_t seed : {1u, 2u}) {
            const StereoFrame raw{5, noise(width, height, seed), noise(width, height, seed + 10)};
            const cv::Mat left = remapped(rig.left, raw.left, flag),
                          right = remapped(rig.right, raw.right, flag);
            support::on_every_instruction_set([&](const std::string& name) {
              const StereoFrame frame = rectifier.rectify(raw);
              EXPECT_EQ(frame.t_ns, 5);
              EXPECT_EQ(cv::norm(frame.left, left, cv::NORM_L1), 0) << name;
              EXPECT_EQ(cv::norm(frame.right, right, cv::NORM_L1), 0) << name;
            });
          }
        }
      }
}

TEST(Rectifier, ReadsImagesWithPaddedRows) {
  const StereoCalibration rig = calibration(100, 60, 1.0, 0.02);
  Rectifier rectifier(rig, Interpolation::nearest);
  const cv::Mat large = noise(130, 60, 3), part = large(cv::Rect(9, 0, 100, 60));
  const cv::Mat expected = rectifier.rectify_left(part.clone()).clone();
  EXPECT_EQ(cv::norm(rectifier.rectify_left(part), expected, cv::NORM_L1), 0);
}

TEST(Rectifier, RefusesImagesOfAnotherSizeOrKind) {
  Rectifier rectifier(calibration(100, 60, 1.0, 0.02), Interpolation::nearest);
  EXPECT_THROW(rectifier.rectify_left(noise(60, 100, 1)), std::logic_error);
  EXPECT_THROW(rectifier.rectify_left(cv::Mat(60, 100, CV_16UC1, cv::Scalar(0))), std::logic_error);
}

TEST(RectifiedRig, TakesFocalLengthBaselineAndCentresFromTheProjections) {
  const StereoCalibration given = calibration(100, 60, 1.0, 0.0);
  const StereoRig rig = rectified_rig(given, 4.0);
  EXPECT_DOUBLE_EQ(rig.focal_px, 95);
  EXPECT_DOUBLE_EQ(rig.baseline_m, 0.3 / 0.95);
  EXPECT_DOUBLE_EQ(rig.infinity_disparity_px(), 0);
  EXPECT_DOUBLE_EQ(rig.disparity_px(3.0), 10);
  StereoCalibration swapped = given;
  std::swap(swapped.left, swapped.right);
  EXPECT_THROW(rectified_rig(swapped, 4.0), std::runtime_error);
}

}  // namespace
}  // namespace understory
