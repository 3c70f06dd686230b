#include <gtest/gtest.h>

#include <string>

#include "perception/io/calibration_file.hpp"
#include "tests/support/euroc_text.hpp"
#include "tests/support/temporary_folder.hpp"

/// What a recording adds to a EuRoC folder's sensor.yaml: how its pair is rectified.
namespace understory {
namespace {

using support::TemporaryFolder;

std::string additions(double center_x_px) {
  return "rectification: [1, 0, 0, 0, 0, -1, 0, 1, 0]\nrectified_intrinsics: [310, " +
         std::to_string(center_x_px) + ", 150]\n";
}

std::string left_text() { return support::euroc_sensor_text(support::euroc_left(), 300, 201); }
std::string right_text() { return support::euroc_sensor_text(support::euroc_right(), 302, 197); }

CalibratedRig rig_of(const TemporaryFolder& folder, const std::string& left, const std::string& right,
                     const CalibrationOptions& options = {}) {
  folder.write("mav0/cam0/sensor.yaml", left);
  folder.write("mav0/cam1/sensor.yaml", right);
  return read_calibrated_rig(folder.path(), options);
}

std::string complaint_of(const TemporaryFolder& folder, const std::string& left, const std::string& right) {
  try {
    rig_of(folder, left, right);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(RecordedEuroc, SaysHowThePairIsRectified) {
  const TemporaryFolder folder;
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
  EXPECT_TRUE(y_body.isApprox(-support::euroc_left().linear().col(2), 1e-12));
}

TEST(RecordedEuroc, TheCallersDepthGoesBeforeTheFiles) {
  const TemporaryFolder folder;
  CalibrationOptions options;
  options.detection_depth_m = 7;
  const std::string left = left_text() + additions(205) + "detection_depth_m: 4.8\n";
  EXPECT_EQ(rig_of(folder, left, right_text() + additions(180), options).rig.detection_depth_m, 7);
}

TEST(RecordedEuroc, TakesOpenCvsLongerDistortions) {
  const TemporaryFolder folder;
  std::string left = left_text();
  const std::string four = "-0.28, 0.07, 0.0002, -0.0001";
  left.replace(left.find(four), four.size(), four + ", 0.01");
  EXPECT_EQ(rig_of(folder, left, right_text()).calibration->left.distortion.size(), 5u);
  left.replace(left.find(four), four.size(), "1, " + four);
  EXPECT_NE(complaint_of(folder, left, right_text()).find("expected a list of 4 numbers, found 6"),
            std::string::npos);
}

TEST(RecordedEuroc, RefusesHalfARectification) {
  const TemporaryFolder folder;
  const auto refuses = [&](const std::string& left, const std::string& right, const std::string& part) {
    const std::string complaint = complaint_of(folder, left_text() + left, right_text() + right);
    EXPECT_NE(complaint.find(part), std::string::npos) << part << " not in: " << complaint;
  };
  refuses(additions(205), "", "rectification: expected in both");
  refuses("rectification: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n", additions(180), "rectified_intrinsics");
  refuses("rectification: [1, 0, 0, 0, 1, 0, 0, 0, 0.9]\nrectified_intrinsics: [310, 205, 150]\n",
          additions(180), "rectification: expected a rotation");
  refuses("rectification: [1, 0, 0, 0, 0, -1, 0, 1, 0]\nrectified_intrinsics: [320, 205, 150]\n",
          additions(180), "same focal length");
}

}  // namespace
}  // namespace understory
