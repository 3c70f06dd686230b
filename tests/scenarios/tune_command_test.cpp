#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/tuning/judge.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory tune` and `--with` as people meet them.
namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace support;
using TuneCommand = FolderTest;

/// Half a second in the air: what takes long in a flight is left out.
const std::string short_flight =
    "name: short\ncourse: clear\ntime_limit_s: 0.5\nforest: {length_m: 10}\ncameras: {rate_hz: 10}\n";

std::string flights_text(const std::string& search) {
  return "scenario: short.yaml\nparameters:\n  autopilot.flight_model.cruise_speed_mps: {from: 9, to: 12}\n"
         "objective: {maximize: progress}\nsearch: " +
         search + "\nover: flights\ntraining: 1000..1001\nvalidation: 1002\n";
}

TEST_F(TuneCommand, RefusesBadInputInOneLine) {
  const std::string here = folder.path().string() + "/";
  folder.write("short.yaml", short_flight);
  folder.write("bad.yaml",
               "scenario: short.yaml\nparameters: {forest.lenght_m: {from: 1, to: 2}}\n"
               "over: flights\n");
  expect_refusal("tune " + here + "none.yaml", "none.yaml: cannot read this");
  expect_refusal("tune " + here + "bad.yaml",
                 "bad.yaml:2: parameters.forest.lenght_m: expected a numeric key");
  folder.write("tune.yaml", flights_text("{method: random, trials: 1}"));
  folder.write("out/tune.json", "{}");
  expect_refusal("tune " + here + "tune.yaml --out " + here + "out", "holds a tuning already: --resume");
  expect_refusal("tune " + here + "tune.yaml --resume --out " + here + "out", "format changed");
}

TEST_F(TuneCommand, WithGoesOverTheScenarioAndItsErrorsNameItsLines) {
  const std::string scenario = folder.write("short.yaml", short_flight).string();
  const std::string wrong = folder.write("wrong.yaml", "forest:\n  lenght_m: 1\n").string();
  const std::string wide = folder.write("wide.yaml", "forest:\n  length_m: -1\n").string();
  const std::string rig = folder.write("rig.yaml", "rig: none\n").string();
  for (const std::string command : {"fly ", "record "}) {
    const std::string begin = command + scenario + " --out " + path("run") + " --with ";
    expect_refusal(begin + wrong, "wrong.yaml:2: forest.lenght_m: unknown key");
    expect_refusal(begin + wide, "wide.yaml:2: forest.length_m: expected a number");
    expect_refusal(begin + rig, "rig.yaml:1: rig: must be a name in");
    expect_refusal(begin + "none.yaml", "none.yaml: cannot read this");
  }
  const std::string some = folder.write("some.yaml", "forest: {length_m: 11, half_width_m: 12}\n").string();
  const fs::path run = folder.path() / "run";
  support::understory("fly " + scenario + " --with " + some + " --set forest.half_width_m=13 --quiet --out " +
                      run.string());
  const Scenario flown = load_scenario(run / "scenario.yaml");
  EXPECT_EQ(flown.forest.length_m, 11);
  EXPECT_EQ(flown.forest.half_width_m, 13);
}

TEST_F(TuneCommand, StoppedAndResumedItEndsWithTheSameLogs) {
  folder.write("short.yaml", short_flight);
  const std::string file =
      folder.write("tune.yaml", flights_text("{method: random, trials: 3, seed: 1, sensitivity: 2}"))
          .string();
  const std::string tune = "tune " + file + " --jobs 2 --out " + folder.path().string() + "/";
  expect_success(tune + "undisturbed");
  for (const char* event : {"ls stopped/flown/training/logs/*.txt", "grep trial stopped/trials.jsonl"})
    support::stopped(tune + "stopped --resume", folder.path().string(), "INT", event);
  expect_success(tune + "stopped --resume");
  for (const char* log :
       {"trials.jsonl", "validation.jsonl", "sensitivity.jsonl", "summary.md", "tune.svg", "pareto.csv"})
    EXPECT_EQ(content_of(folder.path() / "stopped" / log), content_of(folder.path() / "undisturbed" / log))
        << log;
  const std::string fly = "fly " + path("short.yaml") + " --seed 1002 --quiet --with " +
                          fs::directory_iterator(folder.path() / "undisturbed/front")->path().string() +
                          " --out " + path("run");
  EXPECT_LE(support::understory(fly).status, 1);  // flown, to an end good or bad
  EXPECT_TRUE(fs::exists(folder.path() / "run" / "result.json"));
}

TEST_F(TuneCommand, OverRecordingsItsFiguresAreThoseOfTheirEvaluation) {
  const std::string here = folder.path().string() + "/";
  for (const std::string seed : {"1000", "1001", "1002"})
    expect_success(
        "record forest --set time_limit_s=0.6 --set forest.clear_m=2 --set "
        "cameras.rate_hz=20 --seed " +
        seed + " --out " + here + seed);
  const std::string file =
      folder
          .write("tune.yaml",
                 "scenario: forest\nparameters:\n"
                 "  perception.pushbroom.minimum_edge_sum: {from: 100, to: 900}\n"
                 "  perception.pushbroom.score_limit: {from: 0.05, to: 0.4, scale: log}\n"
                 "objective: {maximize: [recall, precision]}\n"
                 "search: {method: nsga2, trials: 20, seed: 1, sensitivity: 2}\nover: recordings\n"
                 "training: ['1000', '1001']\nvalidation: ['1002']\n")
          .string();
  expect_success("tune " + file + " --jobs 1 --out " + here + "one");
  expect_success("tune " + file + " --jobs 2 --out " + here + "two");
  EXPECT_EQ(content_of(folder.path() / "one/trials.jsonl"), content_of(folder.path() / "two/trials.jsonl"));

  const Scenario scenario = load_scenario(fs::path(UNDERSTORY_SOURCE_DIR) / "scenarios/library/forest.yaml");
  const std::vector<fs::path> folders{folder.path() / "1000", folder.path() / "1001"};
  EvaluationOptions options{folders, {}, 1, [](std::int64_t, std::int64_t) {}};
  options.settings.pushbroom() = scenario.perception.pushbroom();
  const EvaluationSum& sum = evaluate(options).all;
  const std::unique_ptr<Judge> judge = vision_judge(folders, 1, 2);
  for (const auto& [detector, index] :
       {std::pair("pushbroom", algorithm::our_rule), std::pair("stereo_bm", algorithm::stereo_bm),
        std::pair("stereo_sgbm", algorithm::stereo_sgbm)}) {
    Scenario with = scenario;
    with.perception.detector = detector;
    if (index != algorithm::our_rule) with.perception.pushbroom().depths_m = {10.1, 6};  // not full stereo's
    const Rates& rates = sum.tallies[index].at_one_pixel();
    EXPECT_GT(rates.recall.value(), 0) << detector;
    const auto known = [](const Share& share) { return share.of > 0 ? share.value() : NAN; };
    EXPECT_THAT(
        judge->figures(judge->measure("all", with).units),
        testing::Pointwise(testing::NanSensitiveDoubleEq(),
                           Figures{known(rates.precision), known(rates.recall), rates.f_score(),
                                   known(found_within(sum.sightings[index], 1)),
                                   known(found_within(sum.sightings[index], 3)),
                                   static_cast<double>(sum.hits[index]) / static_cast<double>(sum.frames),
                                   known(rates.trunk_precision)}))
        << detector;
    const Counts whole = judge->measure("all", with).units[0],
                 glance = judge->measure("all", with, Look::glance).units[0];
    EXPECT_EQ(whole[0], 12) << "frames";
    EXPECT_EQ(glance[0], 2) << "frames";
  }
  Scenario blind = scenario;
  blind.perception.pushbroom().depths_m = {0.2};
  EXPECT_FALSE(judge->measure("blind", blind).refused.empty());
}

}  // namespace
}  // namespace understory
