#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "perception/io/calibration/calibration_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory evaluate` as people meet it.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using EvaluateCommand = FolderTest;

const char* suite = R"(
set: {cameras.rate_hz: 10, time_limit_s: 3}
recordings:
  - {name: short, scenario: forest, seeds: 1007..1008, walk_mps: 5, height_m: 3, set: {world.bark_contrast: 0.5}}
)";

const char* strict = "perception: {detector: stereo_bm, full_stereo: {minimum_pixels_per_cell: 20}}\n";

/// The algorithm's point at this threshold of its curve.
nlohmann::json point_at(const nlohmann::json& sum, const std::string& algorithm, double threshold) {
  for (const nlohmann::json& curve : sum["curves"])
    for (const nlohmann::json& point : curve["points"])
      if (curve["name"] == algorithm && point["threshold"] == threshold) return point;
  return {};
}

/// All figures but the costs, which no two runs share.
nlohmann::json figures(const fs::path& folder) {
  nlohmann::json json = nlohmann::json::parse(content_of(folder / "evaluation.json"));
  for (nlohmann::json* sum : {&json["all"], &json["scenes"][0]})
    for (nlohmann::json& algorithm : (*sum)["algorithms"]) algorithm.erase("median_ms");
  return json;
}

TEST_F(EvaluateCommand, RecordsASuiteAndJudgesIt) {
  const fs::path file = folder.write("short.yaml", suite);
  const fs::path out = folder.path() / "out";
  expect_success("evaluate " + file.string() + " --out " + out.string());
  for (const char* name : {"summary.md", "evaluation.json", "distances.svg", "precision_recall.svg",
                           "response.svg", "first_hits.svg", "heat_map.png", "heat_map_paper.png",
                           "obstacles.csv", "tables/algorithms.csv", "tables/paper.csv"})
    EXPECT_TRUE(fs::is_regular_file(out / name)) << name;
  const nlohmann::json all = figures(out)["all"];
  EXPECT_EQ(all["recordings"], 2);
  EXPECT_EQ(all["frames"], 60);  // two walks of 3 s
  for (const auto& algorithm : all["algorithms"])
    if (algorithm["name"] == "true depth") {
      EXPECT_EQ(algorithm["precision"]["one pixel"]["share"], 1);
      EXPECT_EQ(algorithm["recall"]["one pixel"]["share"], 1);
    }

  // Curves are drawn over the frames of the table, however few: at each algorithm's own setting they meet it.
  const ProgramRun sparse =
      expect_success("evaluate " + (out / "recordings/short-1007").string() +
                     " --every 8 --detector strict=" + folder.write("strict.yaml", strict).string() +
                     " --out " + path("sparse"));
  const nlohmann::json few = figures(folder.path() / "sparse")["all"];
  EXPECT_EQ(few["frames"], 4);
  for (const nlohmann::json* sum : {&all, &few})
    for (const auto& [name, threshold] : {std::pair("StereoBM", 5.0), std::pair("StereoSGBM", 5.0)})
      for (const nlohmann::json& algorithm : (*sum)["algorithms"]) {
        if (algorithm["name"] != name) continue;
        const nlohmann::json point = point_at(*sum, name, threshold);
        EXPECT_EQ(point["precision"], algorithm["precision"]["one pixel"]) << name;
        EXPECT_EQ(point["recall"], algorithm["recall"]["one pixel"]) << name;
      }
  // A detector that a file describes has the figures of that point of the curve.
  EXPECT_EQ(few["algorithms"].back()["precision"]["one pixel"], point_at(few, "StereoBM", 20)["precision"]);
  EXPECT_EQ(few["algorithms"].back()["name"], "strict");
  expect_part(content_of(folder.path() / "sparse/precision_recall.svg"), ", 4 frames<");

  // The same recordings given as folders, one after the other: the same figures.
  const std::string folders =
      (out / "recordings/short-1007").string() + " " + (out / "recordings/short-1008").string();
  const fs::path again = folder.path() / "again";
  expect_success("evaluate " + folders + " --jobs 1 --out " + again.string());
  EXPECT_EQ(figures(out), figures(again));

  expect_refusal("evaluate " + folders + " --set perception.pushbroom.edge=3 --out " + again.string(),
                 "perception.pushbroom.edge: unknown key");
  fs::remove(out / "recordings/short-1008/mav0/depth0/data" /
             fs::directory_iterator(out / "recordings/short-1008/mav0/depth0/data")->path().filename());
  expect_refusal("evaluate " + folders + " --out " + again.string(), "cannot read this file");
}

/// The true disparities of a recording's frames, as another program would leave them: PFM rows from the
/// bottom up.
void write_true_disparities(const fs::path& recording, const fs::path& to, const understory::StereoRig& rig) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(recording / "mav0/depth0/data")) {
    const cv::Mat depth_mm = cv::imread(entry.path().string(), cv::IMREAD_UNCHANGED);
    cv::Mat disparity(depth_mm.size(), CV_32FC1, cv::Scalar(std::numeric_limits<double>::infinity()));
    for (int row = 0; row < depth_mm.rows; ++row)
      for (int column = 0; column < depth_mm.cols; ++column)
        if (const auto value_mm = depth_mm.at<std::uint16_t>(row, column); value_mm > 0)
          disparity.at<float>(row, column) = static_cast<float>(rig.disparity_px(1e-3 * value_mm));
    cv::flip(disparity, disparity, 0);
    std::ofstream file(to / (entry.path().stem().string() + ".pfm"), std::ios::binary);
    file << "Pf\n" << disparity.cols << " " << disparity.rows << "\n-1.0\n";
    file.write(reinterpret_cast<const char*>(disparity.data),
               static_cast<std::streamsize>(disparity.total() * sizeof(float)));
  }
}

// The right principal point lies further right than the left one, as in one rig of the original aircraft:
// what is far away has negative disparities.
TEST_F(EvaluateCommand, DisparitiesMayBeNegativeWhereInfinityIs) {
  const fs::path recording = folder.path() / "a", given = folder.path() / "given",
                 out = folder.path() / "out";
  const fs::path rig = folder.write(
      "rig.yaml",
      "name: negative\nwidth_px: 376\nheight_px: 240\nfocal_px: 321.9355\nbaseline_m: 0.32662\n"
      "center_left_x_px: 174.0\ncenter_right_x_px: 190.5\ncenter_y_px: 120.6\ndetection_depth_m: 10\n"
      "left_camera_body_m: [0.1, 0.16, 0]\npitch_down_deg: 10.97\n");
  expect_success(
      "record forest --seed 1003 --walk=5 --height 3 --set cameras.rate_hz=5 --set time_limit_s=1 --quiet "
      "--set rig=" +
      rig.string() + " --out " + recording.string());
  write_true_disparities(recording, given, understory::read_calibrated_rig(recording, {}).rig);
  expect_success("evaluate " + recording.string() + " --preset robust --disparities exact=" + given.string() +
                 " --out " + out.string());
  expect_part(content_of(out / "tables/disparities.csv"), "exact,100.0,0.0,0.0,0.0,0.000");
}

TEST_F(EvaluateCommand, DisparitiesOfOthersStandBesideOurs) {
  const fs::path recording = folder.path() / "walk-7", given = folder.path() / "given",
                 out = folder.path() / "out";
  expect_success(
      "record forest --seed 1007 --walk=5 --height 3 --set cameras.rate_hz=10 --set time_limit_s=1 --quiet "
      "--out " +
      recording.string());
  const auto rig = understory::read_calibrated_rig(recording, {}).rig;
  write_true_disparities(recording, given / "walk-7", rig);
  expect_success("evaluate " + recording.string() + " --disparities exact=" + given.string() + " --out " +
                 out.string());
  nlohmann::json exact, block_matching;
  const nlohmann::json all = figures(out)["all"];
  for (const nlohmann::json& algorithm : all["algorithms"]) {
    if (algorithm["name"] == "exact") exact = algorithm;
    if (algorithm["name"] == "StereoBM") block_matching = algorithm;
    EXPECT_EQ(algorithm.contains("disparities"), algorithm["name"] == "exact" ||
                                                     algorithm["name"] == "StereoBM" ||
                                                     algorithm["name"] == "StereoSGBM");
  }
  EXPECT_EQ(exact["disparities"]["matched"], exact["disparities"]["true_pixels"]);
  EXPECT_EQ(exact["disparities"]["bad_1"], 0);
  EXPECT_LT(exact["disparities"]["end_point_error_px"], 1e-4);
  EXPECT_GT(exact["precision"]["one pixel"]["share"], 0.99);
  EXPECT_GT(block_matching["disparities"]["bad_1"], 0);
  expect_part(content_of(out / "tables/disparities.csv"), "exact,100.0,0.0,0.0,0.0,0.000");
}

TEST_F(EvaluateCommand, WrongInputIsRefusedInOneLine) {
  const std::string out = " --out " + path("out");
  expect_refusal("evaluate nowhere" + out, "nowhere");
  expect_refusal("evaluate " + folder.path().string() + out, "cam0");
  const auto refuses = [&](const std::string& text, const std::string& part) {
    const fs::path file = folder.write("suite.yaml", text);
    expect_refusal("evaluate " + file.string() + out, part);
  };
  refuses("recordings: []\n", "recordings: expected a list");
  refuses("recording: 1\n", "recording: unknown key (did you mean recordings?)");
  refuses("recordings:\n  - {name: a, scenario: forest}\n", "recordings[0].seeds: expected the seeds to fly");
  refuses("recordings:\n  - {name: a, scenario: forest, seeds: 3..1}\n", "ends before it begins");
  refuses("recordings:\n  - {name: a/b, scenario: forest, seeds: 1}\n",
          "recordings[0].name: expected a name");
  refuses("recordings:\n  - {name: a, scenario: nowhere, seeds: 1}\n", "nowhere");
  refuses("recordings:\n  - {name: a, scenario: forest, seeds: 1, path: no.tum}\n", "no.tum");
  refuses(
      "recordings:\n  - {name: a, scenario: forest, seeds: 1}\n  - {name: a, scenario: dense, seeds: 1}\n",
      "a-1 is given twice");
  refuses("recordings:\n  - {name: a, scenario: forest, seeds: 1, set: {rig: none}}\n", "a-1: ");
  EXPECT_FALSE(fs::exists(folder.path() / "out/summary.md"));
}

}  // namespace
}  // namespace understory::support
