#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "perception/io/calibration/calibration_file.hpp"
#include "tests/support/text.hpp"

/// What many of perception's tests begin with.
namespace understory::support {

inline const std::filesystem::path house_rigs =
    std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models" / "rigs";

inline StereoRig house_rig(const char* name) { return read_rig(house_rigs / name); }

/// The paper's rig (Barry & Tedrake 2015): its principal points lie far apart. Looks along body x.
inline StereoRig paper_rig() {
  StereoRig rig;
  rig.focal_px = 180.4;
  rig.baseline_m = 0.353;
  rig.center_left_x_px = 197.5;
  rig.center_right_x_px = 105.7;
  rig.center_y_px = 101.0;
  rig.T_body_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return rig;
}

/// One line, with `part` in it, from `beginning` on.
inline void expect_line(const std::string& found, const std::string& beginning, const std::string& part) {
  EXPECT_EQ(found.find(beginning), 0u) << found << "\n  should begin with " << beginning;
  expect_part(found, part);
  expect_no_part(found, "\n");
}

/// Uniform noise; `saturated`: of black and white alone.
inline cv::Mat noise(int width_px, int height_px, std::uint64_t seed, bool saturated = false,
                     int type = CV_8UC1) {
  cv::RNG generator(seed);
  cv::Mat image(height_px, width_px, type);
  generator.fill(image, cv::RNG::UNIFORM, 0, 256);
  return saturated ? cv::Mat(image > 127) : image;
}

/// A rectified camera's projection.
inline cv::Matx34d projection_of(double focal_px, double center_x_px, double center_y_px,
                                 double baseline_m = 0) {
  return {focal_px, 0, center_x_px, -focal_px * baseline_m, 0, focal_px, center_y_px, 0, 0, 0, 1, 0};
}

}  // namespace understory::support
