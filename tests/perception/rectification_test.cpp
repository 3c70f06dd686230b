#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/rectification/rectify.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/euroc_text.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

/// The way from space through a raw camera and the Rectifier to the place where StereoRig says, against
/// OpenCV's camera model (cv::projectPoints) as the outside yardstick.
namespace understory {
namespace {

using Encoding = std::function<int(int u_px, int v_px)>;

/// What the Rectifier makes of a picture whose gray levels say where a pixel came from.
StereoFrame rectified(const StereoCalibration& calibration, const Encoding& encode) {
  cv::Mat image(calibration.height_px, calibration.width_px, CV_8UC1);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<unsigned char>(v, u) = static_cast<unsigned char>(encode(u, v));
  Rectifier rectifier(calibration, Interpolation::nearest);
  const StereoFrame frame = rectifier.rectify({0, image, image});
  return {0, frame.left.clone(), frame.right.clone()};
}

/// Which raw pixel each rectified pixel shows, as the Rectifier has it.
struct RawPlaces {
  explicit RawPlaces(const StereoCalibration& calibration)
      : u_low(rectified(calibration, [](int u, int) { return u & 255; })),
        u_high(rectified(calibration, [](int u, int) { return u >> 8; })),
        v_low(rectified(calibration, [](int, int v) { return v & 255; })),
        v_high(rectified(calibration, [](int, int v) { return v >> 8; })) {}

  cv::Point2d left(int u, int v) const {
    return place(u_low.left, u_high.left, v_low.left, v_high.left, u, v);
  }
  cv::Point2d right(int u, int v) const {
    return place(u_low.right, u_high.right, v_low.right, v_high.right, u, v);
  }

  static cv::Point2d place(const cv::Mat& u_low, const cv::Mat& u_high, const cv::Mat& v_low,
                           const cv::Mat& v_high, int u, int v) {
    return {u_low.at<unsigned char>(v, u) + 256.0 * u_high.at<unsigned char>(v, u),
            v_low.at<unsigned char>(v, u) + 256.0 * v_high.at<unsigned char>(v, u)};
  }

  StereoFrame u_low, u_high, v_low, v_high;
};

cv::Point2d projected(const cv::Vec3d& point_left, const cv::Matx33d& R, const cv::Vec3d& t_m,
                      const CameraCalibration& camera) {
  std::vector<cv::Point2d> pixels;
  cv::Vec3d turn;
  cv::Rodrigues(R, turn);
  cv::projectPoints(std::vector<cv::Point3d>{cv::Point3d(point_left)}, turn, t_m, camera.camera_matrix,
                    camera.distortion, pixels);
  return pixels[0];
}

bool inside(const cv::Point2d& pixel, const StereoCalibration& calibration) {
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x <= calibration.width_px - 1 &&
         pixel.y <= calibration.height_px - 1;
}

/// Points at whole disparities land on whole rectified pixels in both eyes, so nearest-pixel maps may be off
/// by half a raw pixel and no more.
void expect_landing(const CalibratedRig& read, const cv::Matx33d& R_right_left, const cv::Vec3d& t_right_m) {
  const StereoRig& rig = read.rig;
  const StereoCalibration& calibration = *read.calibration;
  const RawPlaces places(calibration);
  constexpr double half_px = 0.502;  // the maps' own arithmetic is in single precision
  int count = 0;
  const int infinity_px = static_cast<int>(std::ceil(rig.infinity_disparity_px() + 0.5));
  for (int disparity_px = infinity_px; disparity_px < infinity_px + 40; disparity_px += 3) {
    const double z_m = rig.depth_m(disparity_px);
    for (int v = 0; v < rig.height_px; v += 7) {
      for (int u = std::max(0, disparity_px); u < rig.width_px + std::min(0, disparity_px); u += 11) {
        const cv::Vec3d point_rectified((u - rig.center_left_x_px) * z_m / rig.focal_px,
                                        (v - rig.center_y_px) * z_m / rig.focal_px, z_m);
        const cv::Vec3d point_left = calibration.left.rectification.t() * point_rectified;
        const cv::Point2d left = projected(point_left, cv::Matx33d::eye(), {}, calibration.left);
        const cv::Point2d right = projected(point_left, R_right_left, t_right_m, calibration.right);
        if (!inside(left, calibration) || !inside(right, calibration)) continue;
        const cv::Point2d left_miss = places.left(u, v) - left;
        const cv::Point2d right_miss = places.right(u - disparity_px, v) - right;
        for (const double miss_px : {left_miss.x, left_miss.y, right_miss.x, right_miss.y})
          ASSERT_LE(std::abs(miss_px), half_px) << u << ", " << v << " at " << z_m << " m";
        ++count;
      }
    }
  }
  EXPECT_GT(count, 1000);
}

TEST(Rectification, LandsWhereTheRigSaysWithRealCalibrations) {
  const std::filesystem::path raw = support::house_rigs / "raw";
  for (const auto& [name, unit] : {std::pair("paper.xml", 0.01), {"long.xml", 1.0}}) {
    CalibrationOptions options;
    options.meters_per_unit = unit;
    const CalibratedRig read = read_calibrated_rig(raw / name, options);
    // The files know no R and T: what their rectifications say of them.
    const cv::Matx33d back = read.calibration->right.rectification.t();
    expect_landing(read, back * read.calibration->left.rectification,
                   back * cv::Vec3d(-read.rig.baseline_m, 0, 0));
  }
}

/// A camera's T_BS as OpenCV reads it.
cv::Matx44d body_of_sensor(const std::filesystem::path& file) {
  const cv::FileStorage storage(file.string(), cv::FileStorage::READ);
  std::vector<double> values;
  storage["T_BS"]["data"] >> values;
  return cv::Matx44d(values.data());
}

/// Here the geometry is known apart from any rectification.
void expect_euroc_landing(const std::filesystem::path& mav) {
  const cv::Matx44d T_right_left =
      body_of_sensor(mav / "cam1" / "sensor.yaml").inv() * body_of_sensor(mav / "cam0" / "sensor.yaml");
  const cv::Vec3d t_right_m(T_right_left(0, 3), T_right_left(1, 3), T_right_left(2, 3));
  expect_landing(read_calibrated_rig(mav, {}), T_right_left.get_minor<3, 3>(0, 0), t_right_m);
}

TEST(Rectification, LandsWhereTheRigSaysWithCamerasPlacedInTheBody) {
  const support::TemporaryFolder folder;
  folder.write("cam0/sensor.yaml", support::euroc_sensor_text(support::euroc_left(), 300, 201));
  folder.write("cam1/sensor.yaml", support::euroc_sensor_text(support::euroc_right(), 302, 197));
  expect_euroc_landing(folder.path());
}

TEST(Rectification, LandsWhereTheRigSaysWithEuroc) {
  const std::string name = "stereo/euroc-v1_01";
  const auto path = support::shared_data(name);
  if (!path) GTEST_SKIP() << support::missing_data(name);
  expect_euroc_landing(*path / "mav0");
}

/// The other way round: cv::undistortPoints brings a raw pixel to the rectified one.
TEST(Rectification, OpenCvUndistortsToWhereTheRigSays) {
  const CalibratedRig read = read_calibrated_rig(support::house_rigs / "raw/long.xml", {});
  const StereoCalibration& calibration = *read.calibration;
  for (const double z_m : {2.0, 5.0, 10.0, 40.0}) {
    const cv::Vec3d point_rectified(0.15 * z_m, -0.1 * z_m, z_m);
    const cv::Vec3d point_left = calibration.left.rectification.t() * point_rectified;
    const cv::Vec3d point_right =
        calibration.right.rectification.t() * (point_rectified - cv::Vec3d(read.rig.baseline_m, 0, 0));
    std::vector<cv::Point2d> left, right;
    const auto undistort = [](const cv::Vec3d& point, const CameraCalibration& camera, auto& pixels) {
      const cv::Point2d raw = projected(point, cv::Matx33d::eye(), {}, camera);
      cv::undistortPoints(std::vector<cv::Point2d>{raw}, pixels, camera.camera_matrix, camera.distortion,
                          camera.rectification, camera.projection,
                          cv::TermCriteria(cv::TermCriteria::COUNT, 50, 0));
    };
    undistort(point_left, calibration.left, left);
    undistort(point_right, calibration.right, right);
    EXPECT_NEAR(left[0].x - right[0].x, read.rig.disparity_px(z_m), 1e-3);
    EXPECT_NEAR(left[0].y, right[0].y, 1e-3);
    EXPECT_NEAR(left[0].x, 0.15 * read.rig.focal_px + read.rig.center_left_x_px, 1e-3);
  }
}

using support::noise;

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
    camera.projection =
        support::projection_of(0.95 * width_px, 0.5 * width_px, 0.5 * height_px, side > 0 ? 0.3 / 0.95 : 0);
    (side < 0 ? calibration.left : calibration.right) = camera;
  }
  return calibration;
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
  const cv::Mat expected = rectifier.rectify({0, part.clone(), part}).left.clone();
  EXPECT_EQ(cv::norm(rectifier.rectify({0, part, part}).left, expected, cv::NORM_L1), 0);
}

TEST(Rectifier, RefusesImagesOfAnotherSizeOrKind) {
  Rectifier rectifier(calibration(100, 60, 1.0, 0.02), Interpolation::nearest);
  for (const cv::Mat& wrong : {noise(60, 100, 1), cv::Mat(60, 100, CV_16UC1, cv::Scalar(0))})
    EXPECT_THROW(rectifier.rectify({0, wrong, wrong}), std::logic_error);
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
