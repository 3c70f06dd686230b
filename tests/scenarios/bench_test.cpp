#include "scenarios/bench/bench.hpp"
#include "tests/support/text.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sstream>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

using support::expect_part;

CalibratedRig long_rig() {
  return read_calibrated_rig(UNDERSTORY_SOURCE_DIR "/models/rigs/raw/long.xml", {});
}

TEST(StereoScenes, ShowTextureAtTheDetectionDepthAndNeverTheSameTwice) {
  const CalibratedRig rig = long_rig();
  const std::vector<StereoFrame> frames = stereo_scenes(rig, 4, 1);
  PushbroomConfig config = robust_pushbroom();
  PushbroomStereo detector(rig, config);
  std::size_t hits = 0;
  for (const StereoFrame& frame : frames) hits += detector.detect(frame).size();
  EXPECT_GT(hits, 10u);  // both eyes see one world
  EXPECT_GT(cv::norm(frames[0].left, frames[1].left, cv::NORM_L1), 1e5);
  EXPECT_GT(cv::norm(frames[0].left, frames[0].right, cv::NORM_L1), 1e5);
  const std::vector<StereoFrame> again = stereo_scenes(rig, 1, 1);
  EXPECT_EQ(cv::norm(again[0].right, frames[0].right, cv::NORM_L1), 0);
}

TEST(Bench, HasARowForEachClaimWithItsYardstick) {
  const CalibratedRig rig = long_rig();
  const std::vector<BenchRow> rows = bench_detectors(rig, stereo_scenes(rig, 2, 1), 1, [](int) {});
  const auto list = nlohmann::json::parse(to_json(rows));
  ASSERT_EQ(list.size(), rows.size());
  int with_ratio = 0;
  for (const auto& row : list) {
    EXPECT_GT(row["median_ms"].get<double>(), 0);
    EXPECT_LE(row["median_ms"].get<double>(), row["p99_ms"].get<double>());
    EXPECT_GE(row["threads"].get<int>(), 1);
    if (row["yardstick"].is_null()) continue;
    ++with_ratio;
    const auto yardstick =
        std::ranges::find(list, row["yardstick"], [](const auto& one) { return one["name"]; });
    ASSERT_NE(yardstick, list.end()) << row["name"];
    const double medians = row["median_ms"].get<double>() / (*yardstick)["median_ms"].get<double>();
    EXPECT_NEAR(row["ratio"].get<double>(), medians, 0.01 * medians) << row["name"];
  }
  EXPECT_EQ(with_ratio, static_cast<int>(rows.size()) - 2);  // remap and StereoBM are the yardsticks
}

std::vector<BenchRow> planner_rows(const std::string& text) {
  const std::vector<StereoFrame> frames = stereo_scenes(long_rig(), 1, 1);
  return bench_planner({{Scenario(), "p.csv", text}}, frames, 2, [](int) {});
}

TEST(PlannerBench, CountsProblemsAndComparesTheirSlowest) {
  const std::string points =
                        "flight,7\npoint,8000,100,0,4000\npoint,8000,300,0,4500\npoint,9000,100,0,4200\n",
                    start = ",4500,12,0,0,0,0,0.19,0,0,";
  const std::vector<BenchRow> rows = planner_rows(points + "plan,1000000000,1,0,0,0,0" + start +
                                                  "0-1 2\nplan,1100000000,0,1200,10,1200,0" + start + "\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].name, "2 replans in unnamed");
  EXPECT_EQ(rows[1].yardstick, rows[0].name);
  EXPECT_NEAR(rows[1].p99_ratio, rows[1].p99_ms / rows[0].median_ms, 1e-12);
  EXPECT_GT(rows[1].p99_ms, rows[1].median_ms);  // of one with a trunk ahead and one without
}

TEST(PlannerBench, TheLibraryHas504Problems) {
  int problems = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(UNDERSTORY_SOURCE_DIR "/scenarios/library/problems")) {
    std::istringstream text(unpacked(read_file(file.path(), 1 << 24), 1 << 28).value());
    for (std::string line; std::getline(text, line);) problems += line.starts_with("plan,");
  }
  EXPECT_EQ(problems, 504);  // as the help of bench says
}

TEST(PlannerBench, NamesTheLineThatIsNoProblem) {
  for (const auto& [text, part] :
       {std::pair("plan,1\n", "p.csv:1: expected flight, point or plan"),
        {"flight,7\npoint,1,2\n", "p.csv:2: not a line of problems"},
        {"flight,7\nplan,1,1,0,0,0,0,0,12,0,0,0,0,0.19,0,0,3\n", "p.csv:2: 3 are no points"},
        {"flight,7\nplan,x\n", "p.csv:2: not a line of problems"}})
    expect_part(support::refusal_of([&, text = text] { planner_rows(text); }), part);
}

TEST(ClosedLoopBench, ARowAddsUpItsFlights) {
  const std::vector<TimedFlight> alone{{6, 2, 720, {{"render", 1.0}, {"replan", 0.5}, {"film", 0.1}}, 200, 2},
                                       {4, 3, 480, {{"render", 2.0}, {"detect", 0.25}}, 210, 2.5}};
  const ClosedLoopRow one = closed_loop_row("one", 1, alone, 5, nullptr);
  EXPECT_EQ(one.flights, 2);
  EXPECT_DOUBLE_EQ(one.pairs_per_s, 240);
  EXPECT_DOUBLE_EQ(one.render_ms, 2.5);
  EXPECT_DOUBLE_EQ(one.simulated_per_s, 2);
  EXPECT_DOUBLE_EQ(one.peak_memory_mb, 210);
  EXPECT_DOUBLE_EQ(one.cpu_per_simulated_s, 0.45);
  double sum = 0;
  for (const auto& [stage, share] : one.shares) {
    const double expected = stage == "render"   ? 3.0
                            : stage == "replan" ? 0.5
                            : stage == "detect" ? 0.25
                            : stage == "other"  ? 1.25  // stages not told are in it
                                                : 0;
    EXPECT_NEAR(share, expected / 5, 1e-12) << stage;
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);

  const ClosedLoopRow two = closed_loop_row("two", 2, alone, 3.125, &one);  // side by side
  EXPECT_DOUBLE_EQ(two.simulated_per_s, 3.2);
  EXPECT_DOUBLE_EQ(two.ratio, 0.625);  // of the time
  const auto list = nlohmann::json::parse(to_json(std::vector<ClosedLoopRow>{one, two}));
  ASSERT_EQ(list.size(), 2u);
  EXPECT_TRUE(list[0]["yardstick"].is_null());
  EXPECT_EQ(list[1]["yardstick"], "one");
  EXPECT_EQ(list[1]["processes"], 2);
  EXPECT_DOUBLE_EQ(list[0]["shares"]["render"].get<double>(), 0.6);
  expect_part(to_table({one, two}), "0.62 of one");
}

}  // namespace
}  // namespace understory
