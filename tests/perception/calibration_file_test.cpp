#include "perception/io/calibration/calibration_file.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core/persistence.hpp>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/euroc_text.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using namespace support;
using CalibrationFile = FolderTest;
using RigFile = FolderTest;
using RecordedEuroc = FolderTest;

const std::filesystem::path rigs = house_rigs;

CalibratedRig paper_rig(double depth_m = 4.8) {
  CalibrationOptions options;
  options.meters_per_unit = 0.01;
  options.detection_depth_m = depth_m;
  return read_calibrated_rig(rigs / "raw" / "paper.xml", options);
}

/// Figures of the original aircraft's records: nearest whole disparity and one pixel either way.
TEST_F(CalibrationFile, ThePapersRigLooksWhereItsRecordsSay) {
  const CalibratedRig read = paper_rig();
  EXPECT_EQ(read.rig.name, "paper");
  EXPECT_NEAR(read.rig.focal_px, 180.4, 0.01);
  EXPECT_NEAR(read.rig.baseline_m, 0.353, 1e-4);
  EXPECT_NEAR(read.rig.center_left_x_px, 197.5, 0.05);
  EXPECT_NEAR(read.rig.center_right_x_px, 105.7, 0.01);
  EXPECT_NEAR(read.rig.center_y_px, 101.0, 0.03);
  EXPECT_EQ(read.calibration->left.distortion.size(), 8u);
  EXPECT_EQ(read.calibration->right.distortion.size(), 8u);
  const PushbroomStereo detector(read.rig, original_pushbroom());
  EXPECT_NEAR(detector.detection_depth_m(), 4.81, 0.005);
  EXPECT_NEAR(detector.one_pixel_interval().near_m, 4.47, 0.005);
  EXPECT_NEAR(detector.one_pixel_interval().far_m, 5.20, 0.005);
}

TEST_F(CalibrationFile, TheLaterRigLooksWhereItsRecordsSay) {
  const CalibratedRig read = read_calibrated_rig(rigs / "raw" / "long.xml", {});  // 10 m: nobody says
  EXPECT_NEAR(read.rig.focal_px, 386.9, 0.05);
  EXPECT_NEAR(read.rig.baseline_m, 0.334, 5e-4);
  EXPECT_NEAR(read.calibration->left.camera_matrix(0, 0), 321, 0.5);
  EXPECT_EQ(read.calibration->left.distortion.size(), 5u);
  const PushbroomStereo detector(read.rig, original_pushbroom());
  EXPECT_NEAR(detector.detection_depth_m(), 10.14, 0.005);
  EXPECT_NEAR(detector.one_pixel_interval().near_m, 9.40, 0.005);
  EXPECT_NEAR(detector.one_pixel_interval().far_m, 11.0, 0.05);
}

TEST_F(CalibrationFile, TheRecordsOwnFoldersSayTheSame) {
  for (const auto& [records, name, unit] : {std::tuple("rigs/calib-02-20-2014", "paper.xml", 0.01),
                                            std::tuple("rigs/calib-odroid-cam1", "long.xml", 1.0)}) {
    const auto path = shared_data(records);
    if (!path) GTEST_SKIP() << missing_data(records);
    CalibrationOptions options{unit, 376, 240, 5.0};
    const CalibratedRig theirs = read_calibrated_rig(*path, options);
    const CalibratedRig ours = read_calibrated_rig(rigs / "raw" / name, options);
    EXPECT_EQ(theirs.rig.focal_px, ours.rig.focal_px);
    EXPECT_EQ(theirs.rig.baseline_m, ours.rig.baseline_m);
    EXPECT_EQ(theirs.calibration->right.distortion, ours.calibration->right.distortion);
    EXPECT_EQ(theirs.calibration->right.camera_matrix, ours.calibration->right.camera_matrix);
    EXPECT_EQ(theirs.calibration->left.rectification, ours.calibration->left.rectification);
  }
}

TEST_F(CalibrationFile, RigFilesComeRectified) {
  const CalibratedRig read = read_calibrated_rig(rigs / "paper.yaml", {});
  EXPECT_FALSE(read.calibration);
  EXPECT_EQ(read.rig.detection_depth_m, 4.8);
  EXPECT_TRUE(read.rig.T_body_camera.isApprox(house_rig("paper.yaml").T_body_camera, 0));
  CalibrationOptions options;
  options.detection_depth_m = 3;
  EXPECT_EQ(read_calibrated_rig(rigs / "paper.yaml", options).rig.detection_depth_m, 3);
}

void write_matrices(cv::FileStorage& storage, const StereoCalibration& calibration) {
  storage << "M1" << cv::Mat(calibration.left.camera_matrix) << "D1"
          << cv::Mat(calibration.left.distortion).t() << "R1" << cv::Mat(calibration.left.rectification)
          << "P1" << cv::Mat(calibration.left.projection) << "M2" << cv::Mat(calibration.right.camera_matrix)
          << "D2" << cv::Mat(calibration.right.distortion).t() << "R2"
          << cv::Mat(calibration.right.rectification) << "P2" << cv::Mat(calibration.right.projection);
}

void expect_equal(const StereoCalibration& found, const StereoCalibration& expected) {
  for (const auto& [one, other] : {std::pair(&found.left, &expected.left), {&found.right, &expected.right}}) {
    EXPECT_EQ(one->camera_matrix, other->camera_matrix);
    EXPECT_EQ(one->distortion, other->distortion);
    EXPECT_EQ(one->rectification, other->rectification);
    EXPECT_EQ(one->projection, other->projection);
  }
  EXPECT_EQ(found.width_px, expected.width_px);
  EXPECT_EQ(found.height_px, expected.height_px);
}

/// OpenCV itself writes what we read, every bit of every number.
TEST_F(CalibrationFile, ReadsWhatOpenCvWrites) {
  StereoCalibration calibration = *paper_rig().calibration;  // in metres by now
  for (const char* name : {"one.xml", "one.yml", "one.yaml"}) {
    cv::FileStorage storage(path(name), cv::FileStorage::WRITE);
    storage << "calibration_time"
            << "Thu 20 Feb 2014, 12:00"
            << "image_width" << 376 << "image_height" << 240 << "views" << std::vector<double>{1, 2, 3};
    write_matrices(storage, calibration);
    storage.release();
    expect_equal(*read_calibrated_rig(folder.path() / name, {}).calibration, calibration);
  }
}

TEST_F(CalibrationFile, ReadsFoldersOfOneMatrixAFile) {
  const StereoCalibration calibration = *paper_rig().calibration;
  const cv::FileStorage all((rigs / "raw" / "paper.xml").string(), cv::FileStorage::READ);
  for (const std::string name : {"M1", "D1", "R1", "P1", "M2", "D2", "R2", "P2"}) {
    cv::Mat matrix;
    all[name] >> matrix;  // so OpenCV reads the committed file, too
    cv::FileStorage one((folder.path() / (name + ".xml")).string(), cv::FileStorage::WRITE);
    one << name << matrix;
  }
  CalibrationOptions options{0.01, 376, 240, 4.8};
  const CalibratedRig read = read_calibrated_rig(folder.path(), options);
  expect_equal(*read.calibration, calibration);
  EXPECT_EQ(read.rig.name, folder.path().filename().string());
  EXPECT_EQ(read_calibrated_rig(folder.path() / "", options).rig.name, read.rig.name);
}

/// As OpenCV's stereo_calib sample leaves them; and with 14 coefficients, as cv::stereoCalibrate gives them.
TEST_F(CalibrationFile, RectifiesWhereOnlyRotationAndTranslationAreKnown) {
  const StereoCalibration calibration = *paper_rig().calibration;
  const cv::Matx33d R = calibration.right.rectification.t() * calibration.left.rectification;
  const cv::Vec3d t_cm = calibration.right.rectification.t() * cv::Vec3d(-35.3, 0, 0);
  cv::FileStorage intrinsics(path("intrinsics.yml"), cv::FileStorage::WRITE);
  cv::Mat left14 = cv::Mat::zeros(1, 14, CV_64F);
  cv::Mat(calibration.left.distortion).reshape(0, 1).copyTo(left14.colRange(0, 8));
  intrinsics << "M1" << cv::Mat(calibration.left.camera_matrix) << "D1" << left14 << "M2"
             << cv::Mat(calibration.right.camera_matrix) << "D2" << cv::Mat(calibration.right.distortion);
  intrinsics.release();
  cv::FileStorage extrinsics(path("extrinsics.yml"), cv::FileStorage::WRITE);
  extrinsics << "R" << cv::Mat(R) << "T" << cv::Mat(t_cm);
  extrinsics.release();
  const CalibratedRig read = read_calibrated_rig(folder.path(), {0.01, 376, 240, 4.8});
  EXPECT_EQ(read.calibration->left.distortion, calibration.left.distortion);
  EXPECT_NEAR(read.rig.baseline_m, 0.353, 1e-9);
  EXPECT_NEAR(read.rig.infinity_disparity_px(), 0, 1e-9);  // principal points alike
  // Rectified axes: x along the baseline, whatever turn about it the two libraries' versions choose.
  const cv::Vec3d x_right = read.calibration->right.rectification * t_cm / cv::norm(t_cm);
  EXPECT_NEAR(x_right[0], -1, 1e-9);
}

TEST_F(CalibrationFile, ReadsEurocFoldersAndKeepsTheirBody) {
  folder.write("mav0/cam0/sensor.yaml", euroc_sensor_text(euroc_left(), 300, 201));
  folder.write("mav0/cam1/sensor.yaml", euroc_sensor_text(euroc_right(), 302, 197));
  for (const std::filesystem::path& path : {folder.path(), folder.path() / "mav0", folder.path() / "mav0/"}) {
    const CalibratedRig read = read_calibrated_rig(path, {});
    EXPECT_EQ(read.rig.name, folder.path().filename().string());
    EXPECT_EQ(read.rig.width_px, 400);
    EXPECT_EQ(read.rig.height_px, 300);
    EXPECT_EQ(read.calibration->left.camera_matrix, cv::Matx33d(300, 0, 201, 0, 301, 148.5, 0, 0, 1));
    EXPECT_EQ(read.calibration->right.distortion, (std::vector<double>{-0.28, 0.07, 0.0002, -0.0001}));
    EXPECT_TRUE(read.calibration->T_body_left.isApprox(euroc_left(), 1e-12));
    const Eigen::Vector3d between_body_m = euroc_right().translation() - euroc_left().translation();
    EXPECT_NEAR(read.rig.baseline_m, between_body_m.norm(), 1e-9);
    // The rectified camera's x axis points to the right camera.
    EXPECT_TRUE(read.rig.T_body_camera.linear().col(0).isApprox(between_body_m.normalized(), 1e-9));
    EXPECT_TRUE(read.rig.T_body_camera.translation().isApprox(euroc_left().translation(), 1e-12));
  }
}

TEST_F(CalibrationFile, ReadsARealEurocFolder) {
  const std::string name = "stereo/euroc-v1_01";
  const auto path = shared_data(name);
  if (!path) GTEST_SKIP() << missing_data(name);
  const CalibratedRig read = read_calibrated_rig(*path, {});
  EXPECT_EQ(read.rig.width_px, 752);
  EXPECT_EQ(read.rig.height_px, 480);
  EXPECT_NEAR(read.rig.baseline_m, 0.110, 5e-4);  // as the MAV's makers give it: 11 cm
  EXPECT_NEAR(read.rig.focal_px, 458, 25);        // near the raw cameras' own
  // Cameras look along the IMU's z.
  EXPECT_NEAR(read.rig.T_body_camera.linear()(2, 2), 1, 0.01);
}

constexpr const char* good =
    "name: test\nwidth_px: 376\nheight_px: 240\nfocal_px: 180\nbaseline_m: 0.35\ncenter_left_x_px: 197\n"
    "center_right_x_px: 105\ncenter_y_px: 101\ndetection_depth_m: 4.8\nleft_camera_body_m: [0.1, 0.2, 0.3]\n"
    "pitch_down_deg: 30\n";

std::string complaint_of_rig(const std::string& text) {
  const TemporaryFolder folder;
  return refusal_of([&] { read_rig(folder.write("rig.yaml", text)); });
}

void expect_complaint(const std::string& from, const std::string& to, const std::string& line_and_key,
                      const std::string& expectation) {
  std::string text = good;
  text.replace(text.find(from), from.size(), to);
  const std::string found = complaint_of_rig(text);
  expect_line(found.substr(found.find("rig.yaml")), "rig.yaml:" + line_and_key + ":", expectation);
}

TEST_F(RigFile, ReadsEveryKey) {
  const StereoRig rig = read_rig(folder.write("rig.yaml", good));
  EXPECT_EQ(rig.name, "test");
  EXPECT_EQ(rig.width_px, 376);
  EXPECT_EQ(rig.height_px, 240);
  EXPECT_EQ(rig.focal_px, 180);
  EXPECT_EQ(rig.baseline_m, 0.35);
  EXPECT_EQ(rig.center_left_x_px, 197);
  EXPECT_EQ(rig.center_right_x_px, 105);
  EXPECT_EQ(rig.center_y_px, 101);
  EXPECT_EQ(rig.detection_depth_m, 4.8);
  EXPECT_TRUE(rig.T_body_camera.translation().isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
  // Pitched down 30 deg: the axis points ahead and down, the image's right to the right of the aircraft.
  const Eigen::Matrix3d R = rig.T_body_camera.linear();
  EXPECT_TRUE(R.col(2).isApprox(Eigen::Vector3d(std::sqrt(0.75), 0, -0.5), 1e-12));
  EXPECT_TRUE(R.col(0).isApprox(Eigen::Vector3d(0, -1, 0), 1e-12));
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
  EXPECT_TRUE((R.transpose() * R).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
}

TEST_F(RigFile, NamesFileLineAndKeyOfEveryFault) {
  expect_complaint("focal_px: 180", "focal_pix: 180", "1: focal_px", "missing");
  expect_complaint("pitch_down_deg: 30", "pitch_down_deg: 30\ncolour: red", "12: colour", "unknown key");
  expect_complaint("height_px: 240", "height_px: 240\nwidth_px: 376", "4: width_px", "twice");
  expect_complaint("focal_px: 180", "focal_px: wide", "4: focal_px", "expected a number from 10 to 20000");
  expect_complaint("focal_px: 180", "focal_px: [180]", "4: focal_px", "expected a number");
  expect_complaint("focal_px: 180", "focal_px: .nan", "4: focal_px", "expected a number");
  expect_complaint("baseline_m: 0.35", "baseline_m: -0.35", "5: baseline_m", "from 0.01 to 10");
  expect_complaint("width_px: 376", "width_px: 376.5", "2: width_px", "whole number");
  expect_complaint("[0.1, 0.2, 0.3]", "[0.1, 0.2]", "10: left_camera_body_m", "three numbers");
  expect_complaint("name: test", "name: [a]", "1: name", "a word");
  expect_complaint("detection_depth_m: 4.8", "detection_depth_m: 900", "9: detection_depth_m", "infinity");
  expect_complaint("height_px: 240", "height_px: [240", "3", "closes");
}

TEST_F(RigFile, SaysWhenThereIsNothingToRead) {
  for (const char* text : {"", "just text"}) EXPECT_NE(complaint_of_rig(text), "");
  for (const char* none : {"/proc/nowhere/rig.yaml", "/tmp"})
    EXPECT_THROW(read_rig(none), std::runtime_error);
}

TEST(HouseRigs, LookAlongThePathWithTheAxisLevelAtTrim) {
  for (const char* name : {"paper.yaml", "long.yaml"}) {
    const StereoRig rig = house_rig(name);
    const double trim_rad = 10.97 * std::numbers::pi / 180;  // level trim at 12.27 m/s, nose up
    const Eigen::Matrix3d nose_up = Eigen::AngleAxisd(-trim_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    EXPECT_TRUE((nose_up * rig.T_body_camera.linear().col(2)).isApprox(Eigen::Vector3d::UnitX(), 1e-12))
        << name;
    EXPECT_NEAR(rig.T_body_camera.translation().y(), rig.baseline_m / 2, 1e-4) << name;
  }
}

/// What a recording adds to a EuRoC folder's sensor.yaml: how its pair is rectified.
std::string additions(double center_x_px) {
  return "rectification: [1, 0, 0, 0, 0, -1, 0, 1, 0]\nrectified_intrinsics: [310, " +
         std::to_string(center_x_px) + ", 150]\n";
}

std::string left_text() { return euroc_sensor_text(euroc_left(), 300, 201); }
std::string right_text() { return euroc_sensor_text(euroc_right(), 302, 197); }

CalibratedRig rig_of(const TemporaryFolder& folder, const std::string& left, const std::string& right,
                     const CalibrationOptions& options = {}) {
  folder.write("mav0/cam0/sensor.yaml", left);
  folder.write("mav0/cam1/sensor.yaml", right);
  return read_calibrated_rig(folder.path(), options);
}

std::string complaint_of(const TemporaryFolder& folder, const std::string& left, const std::string& right) {
  return refusal_of([&] { rig_of(folder, left, right); });
}

TEST_F(RecordedEuroc, SaysHowThePairIsRectified) {
  const CalibratedRig read = rig_of(folder, left_text() + additions(205) + "detection_depth_m: 4.8\n",
                                    right_text() + additions(180));
  EXPECT_EQ(read.rig.focal_px, 310);
  EXPECT_EQ(read.rig.center_left_x_px, 205);
  EXPECT_EQ(read.rig.center_right_x_px, 180);
  EXPECT_EQ(read.rig.center_y_px, 150);
  EXPECT_EQ(read.rig.detection_depth_m, 4.8);
  EXPECT_NEAR(read.rig.baseline_m, Eigen::Vector3d(0.2, 0.003, -0.002).norm(), 1e-12);
  EXPECT_EQ(read.calibration->left.rectification, cv::Matx33d(1, 0, 0, 0, 0, -1, 0, 1, 0));
  // The rectified camera's y axis is the raw one's -z.
  const Eigen::Vector3d y_body = read.rig.T_body_camera.linear().col(1);
  EXPECT_TRUE(y_body.isApprox(-euroc_left().linear().col(2), 1e-12));
}

TEST_F(RecordedEuroc, TheCallersDepthGoesBeforeTheFiles) {
  CalibrationOptions options;
  options.detection_depth_m = 7;
  const std::string left = left_text() + additions(205) + "detection_depth_m: 4.8\n";
  EXPECT_EQ(rig_of(folder, left, right_text() + additions(180), options).rig.detection_depth_m, 7);
}

TEST_F(RecordedEuroc, TakesOpenCvsLongerDistortions) {
  std::string left = left_text();
  const std::string four = "-0.28, 0.07, 0.0002, -0.0001";
  left.replace(left.find(four), four.size(), four + ", 0.01");
  EXPECT_EQ(rig_of(folder, left, right_text()).calibration->left.distortion.size(), 5u);
  left.replace(left.find(four), four.size(), "1, " + four);
  expect_part(complaint_of(folder, left, right_text()), "must be a list of 4 numbers, found 6");
}

TEST_F(RecordedEuroc, RefusesHalfARectification) {
  const auto refuses = [&](const std::string& left, const std::string& right, const std::string& part) {
    expect_part(complaint_of(folder, left_text() + left, right_text() + right), part);
  };
  refuses(additions(205), "", "rectification: must be in the files of both");
  refuses("rectification: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n", additions(180), "rectified_intrinsics");
  refuses("rectification: [1, 0, 0, 0, 1, 0, 0, 0, 0.9]\nrectified_intrinsics: [310, 205, 150]\n",
          additions(180), "rectification: must be a rotation");
  refuses("rectification: [1, 0, 0, 0, 0, -1, 0, 1, 0]\nrectified_intrinsics: [320, 205, 150]\n",
          additions(180), "must be the same in both");
}

}  // namespace
}  // namespace understory
