#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/stereo_recording.hpp"
#include "perception/io/text_table.hpp"
#include "perception/rectification/rectify.hpp"
#include "tests/support/program.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

/// understory detect on a real camera's pairs: EuRoC MAV, V1_01 (not part of this repository).
namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace support;

struct DetectReal : testing::Test {
  static constexpr const char* name = "stereo/euroc-v1_01";
  fs::path euroc = support::shared_data(name).value_or("");
  support::TemporaryFolder folder;
  void SetUp() override {
    if (euroc.empty()) GTEST_SKIP() << support::missing_data(name);
  }

  /// Dense disparity of every frame, by OpenCV's semi-global matching, in 1/16 px.
  std::vector<cv::Mat> dense_disparities() {
    StereoRecording recording({euroc});
    Rectifier rectifier(*read_calibrated_rig(euroc, {}).calibration, Interpolation::nearest);
    const auto matcher = cv::StereoSGBM::create(0, 96, 5, 8 * 25, 32 * 25, 1, 31, 10, 100, 2);
    std::vector<cv::Mat> all;
    for (StereoFrame frame; recording.read(frame);) {
      const StereoFrame rectified = rectifier.rectify(frame);
      matcher->compute(rectified.left, rectified.right, all.emplace_back());
    }
    return all;
  }
};

struct Agreement {
  int hits = 0;
  int within_a_pixel = 0;  ///< of the dense disparity at the block's centre
};

Agreement agreement(const std::string& csv, const std::vector<cv::Mat>& disparities) {
  Agreement found;
  const std::string text = csv.substr(csv.find('\n') + 1);
  for (const TableLine& line : table_lines(text, CellsParted::by_commas, "")) {
    const auto cell = [&](std::size_t i) { return static_cast<int>(*number_in(line.cells[i])); };
    const cv::Mat& dense = disparities[static_cast<std::size_t>(cell(0))];
    const int sixteenths = dense.at<std::int16_t>(cell(5) + 2, cell(6) + 2);
    found.hits += 1;
    found.within_a_pixel += std::abs(sixteenths - 16 * cell(7)) <= 16 ? 1 : 0;
  }
  return found;
}

TEST_F(DetectReal, HitsLieWhereDenseMatchingPutsThem) {
  const std::vector<cv::Mat> disparities = dense_disparities();
  ASSERT_EQ(disparities.size(), 4u);
  const std::string out = (folder.path() / "out").string();
  const auto detect = [&](const std::string& more) {
    const ProgramRun outcome = expect_success("detect " + euroc.string() + " --out " + out + more);
    EXPECT_NE(outcome.text.find("4 of 752x480 px, rectified here"), std::string::npos) << outcome.text;
    return agreement(support::content_of(out + "/points.csv"), disparities);
  };
  // Where a checkerboard stands. A fifth of the dense pixels lie within a pixel of this depth.
  const Agreement robust = detect(" --depth 2.2"), paper = detect(" --depth 2.2 --preset original");
  EXPECT_GT(robust.hits, 100);
  EXPECT_GT(robust.within_a_pixel, 0.9 * robust.hits);
  const Agreement smooth = detect(" --depth 2.2 --rectify bilinear");
  EXPECT_GT(smooth.hits, robust.hits);  // less noise between the eyes' rows
  EXPECT_GT(smooth.within_a_pixel, 0.9 * smooth.hits);
  EXPECT_GT(paper.hits, 200);
  EXPECT_GT(paper.within_a_pixel, 0.609 * paper.hits);  // the paper's share within 0.5 m on its own images
  EXPECT_GT(detect(" --depth 3").hits, 4);
  // Nothing stands within 1.2 m of the camera.
  EXPECT_LT(detect(" --depth 1.2").hits, 20);
}

TEST_F(DetectReal, AVehicleAtRestRemembersEachPointOnce) {
  const std::string poses =
      folder.write("poses.csv", "1403715273262142976,1,2,3,1,0,0,0\n1403715276262142976,1,2,3,1,0,0,0\n")
          .string();
  const std::string out = (folder.path() / "out").string();
  expect_success("detect " + (euroc / "mav0").string() + " --depth 2.2 --poses " + poses + " --out " + out);
  const auto lines = [&](const char* file) {
    const std::string text = support::content_of(out + "/" + file);
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto hits = lines("points.csv") - 1, remembered = lines("map.ply") - 11;
  EXPECT_GT(remembered, 20);
  EXPECT_LT(remembered, hits / 2);  // four looks at the same board
}

TEST_F(DetectReal, ACalibrationOfAnotherResolutionIsRefused) {
  support::expect_refusal("detect " + euroc.string() + " --rig paper --out " + folder.path().string(),
                          "must be 376x240 as");
}

}  // namespace
}  // namespace understory
