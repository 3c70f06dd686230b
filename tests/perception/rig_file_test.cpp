#include "perception/io/rig_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "tests/perception/rigs.hpp"

namespace understory {
namespace {

constexpr const char* good =
    "name: test\nwidth_px: 376\nheight_px: 240\nfocal_px: 180\nbaseline_m: 0.35\ncenter_left_x_px: 197\n"
    "center_right_x_px: 105\ncenter_y_px: 101\ndetection_depth_m: 4.8\nleft_camera_body_m: [0.1, 0.2, 0.3]\n"
    "pitch_down_deg: 30\n";

class RigFile : public testing::Test {
 protected:
  std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) /
      (std::string("rig_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".yaml");
  void TearDown() override { std::filesystem::remove(file); }

  void write(const std::string& text) { std::ofstream(file) << text; }

  std::string complaint(std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    write(text);
    try {
      read_rig(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }

  void expect_complaint(const std::string& from, const std::string& to, const std::string& line_and_key,
                        const std::string& expectation) {
    const std::string found = complaint(good, from, to);
    EXPECT_EQ(found.find(file.string() + ":" + line_and_key + ": "), 0u) << found;
    EXPECT_NE(found.find(expectation), std::string::npos) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
};

TEST_F(RigFile, ReadsEveryKey) {
  write(good);
  const StereoRig rig = read_rig(file);
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
  expect_complaint("focal_px: 180", "focal_pix: 180", "1: focal_px", "found none");
  expect_complaint("pitch_down_deg: 30", "pitch_down_deg: 30\ncolour: red", "12: colour", "unknown key");
  expect_complaint("height_px: 240", "height_px: 240\nwidth_px: 376", "4: width_px", "once");
  expect_complaint("focal_px: 180", "focal_px: wide", "4: focal_px", "expected a number from 10 to 20000");
  expect_complaint("focal_px: 180", "focal_px: [180]", "4: focal_px", "expected a number");
  expect_complaint("focal_px: 180", "focal_px: .nan", "4: focal_px", "expected a number");
  expect_complaint("baseline_m: 0.35", "baseline_m: -0.35", "5: baseline_m", "from 0.01 to 10");
  expect_complaint("width_px: 376", "width_px: 376.5", "2: width_px", "whole number");
  expect_complaint("[0.1, 0.2, 0.3]", "[0.1, 0.2]", "10: left_camera_body_m", "3 numbers");
  expect_complaint("name: test", "name: [a]", "1: name", "text");
  expect_complaint("detection_depth_m: 4.8", "detection_depth_m: 900", "9: detection_depth_m", "infinity");
  expect_complaint("height_px: 240", "height_px: [240", "4: rig", "YAML");
}

TEST_F(RigFile, SaysWhenThereIsNothingToRead) {
  EXPECT_THROW(read_rig("/nonexistent/rig.yaml"), std::runtime_error);
  EXPECT_THROW(read_rig(testing::TempDir()), std::runtime_error);
  write("just text");
  EXPECT_THROW(read_rig(file), std::runtime_error);
  write("");
  EXPECT_THROW(read_rig(file), std::runtime_error);
}

TEST(HouseRigs, LookAlongThePathWithTheAxisLevelAtTrim) {
  for (const char* name : {"paper.yaml", "long.yaml"}) {
    const StereoRig rig = support::house_rig(name);
    const double trim_rad = 10.97 * std::numbers::pi / 180;  // level trim at 12.27 m/s, nose up
    const Eigen::Matrix3d nose_up = Eigen::AngleAxisd(-trim_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    EXPECT_TRUE((nose_up * rig.T_body_camera.linear().col(2)).isApprox(Eigen::Vector3d::UnitX(), 1e-12))
        << name;
    EXPECT_NEAR(rig.T_body_camera.translation().y(), rig.baseline_m / 2, 1e-4) << name;
  }
}

}  // namespace
}  // namespace understory
