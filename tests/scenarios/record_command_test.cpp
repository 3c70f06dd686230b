#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory record` as people meet it.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using RecordCommand = FolderTest;

const std::string flight = " forest --seed 1007 --set time_limit_s=0.9 --set cameras.rate_hz=60";

TEST_F(RecordCommand, RecordingChangesNoFlight) {
  const std::string flown = path("flown"), kept = path("kept");
  EXPECT_EQ(understory("fly --quiet" + flight + " --out " + flown).status, 1);  // time is over
  const auto outcome = understory("record" + flight + " --out " + kept);
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  const auto digest = [](const std::string& run) {
    return nlohmann::json::parse(content_of(fs::path(run) / "result.json")).at("digest");
  };
  EXPECT_EQ(digest(flown), digest(kept));
  EXPECT_EQ(content_of(fs::path(flown) / "scenario.yaml"), content_of(fs::path(kept) / "scenario.yaml"));
  for (const char* sensor :
       {"cam0", "cam1", "imu0", "state_groundtruth_estimate0", "estimate0", "depth0", "objects0"})
    for (const char* file : {"sensor.yaml", "data.csv"})
      EXPECT_TRUE(fs::is_regular_file(fs::path(kept) / "mav0" / sensor / file)) << sensor << ", " << file;
  expect_refusal("record" + flight + " --out " + kept, "holds results already: --force");
}

TEST_F(RecordCommand, TwoRecordingsOfAWoodHoldTheSameBytes) {
  const fs::path one = folder.path() / "one", other = folder.path() / "other";
  for (const fs::path& kept : {one, other}) {
    const auto outcome = understory(
        "record woods --seed 1007 --path scenarios/library/paths/level.tum --set "
        "cameras.rate_hz=2 --out " +
        kept.string());
    EXPECT_EQ(outcome.status, 0) << outcome.text;
  }
  int files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(one / "mav0")) {
    if (!entry.is_regular_file()) continue;
    EXPECT_TRUE(content_of(entry.path()) == content_of(other / fs::relative(entry.path(), one))) << entry;
    ++files;
  }
  EXPECT_GT(files, 40);
  const std::string objects = content_of(one / "mav0" / "objects0" / "objects.csv");
  for (const char* kind : {"trunk", "branch", "foliage", "undergrowth"}) expect_part(objects, kind);
}

std::vector<double> numbers_in(const fs::path& file) {
  std::istringstream stream(content_of(file));
  return {std::istream_iterator<double>(stream), {}};
}

std::vector<fs::path> images_in(const fs::path& at) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(at)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// Three recordings of one flight say the same of it, read by OpenCV: EuRoC's depth in millimetres, KITTI's
/// disparities in 256ths, Middlebury's in PFM.
TEST_F(RecordCommand, TheFormsOfKittiAndOfMiddleburySayWhatEurocsSays) {
  for (const std::string form : {"euroc", "kitti", "middlebury"})
    expect_success("record --quiet" + flight + " --every 10 --format " + form + " --out " + path(form));
  const std::vector<fs::path> lefts = images_in(path("euroc/mav0/cam0/data")),
                              depths = images_in(path("euroc/mav0/depth0/data"));
  const std::vector<double> poses = numbers_in(path("kitti/training/poses.txt")),
                            times = numbers_in(path("kitti/training/times.txt"));
  ASSERT_GT(lefts.size(), 3u);
  ASSERT_EQ(times.size(), lefts.size());
  ASSERT_EQ(poses.size(), 12 * lefts.size());
  EXPECT_EQ(content_of(path("kitti/training/poses.txt")), content_of(path("middlebury/pairs/poses.txt")));
  std::istringstream calibration(content_of(path("kitti/training/calib/000000.txt")));
  std::string left_name, right_name;
  cv::Matx34d left_camera, right_camera;
  calibration >> left_name;
  for (double& value : left_camera.val) calibration >> value;
  calibration >> right_name;
  for (double& value : right_camera.val) calibration >> value;
  EXPECT_EQ(left_name + right_name, "P0:P1:");
  const double focal_px = left_camera(0, 0), baseline_m = -right_camera(0, 3) / focal_px;
  const double infinity_px = left_camera(0, 2) - right_camera(0, 2);
  std::int64_t seen = 0, hidden = 0;
  for (std::size_t i = 0; i < lefts.size(); ++i) {
    const std::string number = "00000" + std::to_string(i), pair = path("middlebury/pairs/" + number);
    const auto image = [](const std::string& file) { return cv::imread(file, cv::IMREAD_UNCHANGED); };
    const cv::Mat left = image(lefts[i].string());
    EXPECT_EQ(cv::norm(left, image(path("kitti/training/image_0/" + number + "_10.png")), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(left, image(pair + "/im0.png"), cv::NORM_INF), 0);
    const cv::Mat depth_mm = image(depths[i].string()), disparity = image(pair + "/disp0.pfm"),
                  mask = image(pair + "/mask0nocc.png"),
                  all = image(path("kitti/training/disp_occ/" + number + "_10.png")),
                  shared = image(path("kitti/training/disp_noc/" + number + "_10.png"));
    ASSERT_EQ(disparity.type(), CV_32FC1);
    ASSERT_EQ(all.type(), CV_16UC1);
    for (int row = 0; row < left.rows; row += 3)
      for (int column = 0; column < left.cols; column += 3) {
        const double depth_m = 1e-3 * depth_mm.at<std::uint16_t>(row, column);
        const float exact = disparity.at<float>(row, column);
        const double rounded = all.at<std::uint16_t>(row, column) / 256.0;
        const int both = shared.at<std::uint16_t>(row, column), sees = mask.at<std::uint8_t>(row, column);
        if (depth_m == 0) {  // the sky, and what is beyond 65.535 m
          ASSERT_TRUE(std::isinf(exact) || exact - infinity_px < focal_px * baseline_m / 65);
          continue;
        }
        const double expected = focal_px * baseline_m / depth_m + infinity_px;
        ASSERT_NEAR(exact, expected, 0.001 * expected);
        ASSERT_NEAR(rounded, exact, 0.5 / 256 + 1e-6);
        ASSERT_EQ(both != 0, sees == 255);
        if (both != 0) {
          ASSERT_EQ(both, all.at<std::uint16_t>(row, column));
        }
        (sees == 255 ? seen : hidden) += 1;
      }
  }
  EXPECT_GT(seen, 10 * hidden);
  EXPECT_GT(hidden, 100);  // beside trunks, and at the left edge
  // Poses count from the first camera's: forward is z.
  EXPECT_EQ(poses[0], 1);
  EXPECT_EQ(poses[11], 0);
  EXPECT_GT(poses[poses.size() - 1], 3);
  for (const std::string pairs : {"kitti", "middlebury/pairs"})
    expect_part(
        expect_success("evaluate --pairs " + path(pairs) + " --every 3 --out " + path("evaluated")).text,
        "within 0.5 m, %");
}

TEST_F(RecordCommand, WrongArgumentsAreBadInput) {
  expect_refusal("record forest --format kitti --set cameras.raw=true --out " + path("raw"),
                 "cameras.raw: KITTI's and Middlebury's forms hold rectified pairs");
  expect_refusal("record forest --format pdf --out " + path("pdf"), "--format");
  expect_refusal("record forest --every 0 --out " + path("none"), "--every");
  expect_refusal("fly forest --record kitti --row " + path("row.json"), "--record requires --out");
  const std::string out = " --out " + path("out");
  expect_refusal("record forest", "--out");
  expect_refusal("record nowhere" + out, "nowhere");
  expect_refusal("record forest --walk=0" + out, "--walk");
  expect_refusal("record forest --walk --height 20" + out, "--height");
  expect_refusal("record forest --height 2" + out, "--height requires --walk");
  expect_refusal("record forest --walk --set forest.square_metres_per_tree=4" + out, "straight lane");
  expect_refusal("record forest --path nowhere.tum" + out, "nowhere.tum: cannot read this file");
  expect_refusal("record forest --path scenarios/library/paths/level.tum --walk" + out,
                 "--path and --walk exclude");
  expect_refusal("record forest --path scenarios/library/paths/level.tum --height 2" + out,
                 "--height requires --walk");
  expect_refusal("record forest --set rig=none" + out, "rig: must be a name");
  expect_refusal("record forest --out /proc/none", "/proc/none");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
}  // namespace understory::support
