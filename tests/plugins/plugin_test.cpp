#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// Parts of plug-ins: the examples fly in every command, a twin of ours is ours, defects are found by name,
/// wrong files are one line.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string plugin(const std::string& name) { return std::string(PLUGINS) + "/" + name + ".so"; }

/// Lines of `text` that hold all of `words`.
int lines_with(const std::string& text, const std::vector<std::string>& words) {
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    bool holds = true;
    for (const std::string& word : words) holds = holds && line.find(word) != std::string::npos;
    if (holds) ++count;
  }
  return count;
}

struct Plugins : FolderTest {
  /// The row of a flight of 20 m.
  Json row(const std::string& arguments) {
    const fs::path file = folder.path() / "row.json";
    fs::remove(file);
    const ProgramRun outcome =
        understory("fly " + arguments + " --set forest.length_m=20 --quiet --row " + file.string());
    EXPECT_LE(outcome.status, 1) << arguments << "\n" << outcome.text;
    return Json::parse(std::ifstream(file)).at("row");
  }
};

TEST_F(Plugins, ATwinOfOursHasOurDigest) {
  const Json ours = row("forest --seed 1003");
  const Json twins = row("forest --seed 1003 --plugin " + plugin("twin") +
                         " --set perception.detector=pushbroom_twin --set autopilot.method=sst_twin");
  EXPECT_EQ(ours.at("digest"), twins.at("digest"));
  EXPECT_NE(row("forest --seed 1004").at("digest"), ours.at("digest"));
}

TEST_F(Plugins, AreListedWithTheirKeys) {
  const ProgramRun list = expect_success("plugin " + plugin("edge_detector") + " " + plugin("slalom_course"));
  EXPECT_EQ(lines_with(list.text, {"detector", "edges", "perception.detector=edges"}), 1) << list.text;
  EXPECT_EQ(lines_with(list.text, {"perception.edges.depth_m", "10", "2 .. 40", "depth at which"}), 1);
  EXPECT_EQ(lines_with(list.text, {"slalom.offset_m", "0.6", "distance of each pole"}), 1) << list.text;
  const ProgramRun ours = expect_success("plugin");
  for (const char* name : {"pushbroom", "dead_reckoning", "library", "fence"})
    EXPECT_GE(lines_with(ours.text, {name}), 1) << name;
  expect_no_part(ours.text, "edges");
}

/// Named in a scenario beside which it lies, with keys of its own, it flies again from what a run left.
TEST_F(Plugins, FlyFromAScenarioAndAgainFromItsRun) {
  fs::copy_file(plugin("slalom_course"), folder.path() / "mine.so");
  const fs::path scenario =
      folder.write("a.yaml",
                   "plugins: [{file: mine.so}]\ncourse: slalom\nslalom: {spacing_m: 9}\n"
                   "perception: {detector: true_depth}\nforest: {length_m: 20}\n");
  const fs::path run = folder.path() / "run";
  const ProgramRun flown =
      understory("fly " + scenario.string() + " --seed 1001 --quiet --out " + run.string());
  ASSERT_LE(flown.status, 1) << flown.text;
  std::ifstream written(run / "scenario.yaml");
  const std::string text{std::istreambuf_iterator<char>(written), {}};
  expect_part(text, "mine.so");
  expect_part(text, "spacing_m: 9");
  EXPECT_EQ(row((run / "scenario.yaml").string()).at("digest"),
            Json::parse(std::ifstream(run / "result.json")).at("digest"));
  // Another build of the plug-in is not the one that flew.
  std::ofstream(folder.path() / "mine.so", std::ios::app) << "x";
  expect_refusal("fly " + (run / "scenario.yaml").string() + " --quiet", "hash: must be");
}

TEST_F(Plugins, EveryKindFlies) {
  EXPECT_GT(row("forest --seed 1003 --plugin " + plugin("edge_detector") + " --set perception.detector=edges")
                .at("detections"),
            100);
  const Json swerved = row("forest --seed 1003 --plugin " + plugin("swerve_planner") +
                           " --set autopilot.method=swerve --set autopilot.swerve.bank_rad=0.7");
  EXPECT_GT(swerved.at("replans"), 10);
  row("forest --seed 1003 --plugin " + plugin("compass_source") + " --set estimation.source=compass");
  row("forest --seed 1003 --plugin " + plugin("slalom_course") + " --set course=slalom");
}

/// What a recorded flight's images give is what the flight saw: also for a detector of a plug-in.
TEST_F(Plugins, DetectInRecordings) {
  const std::string recording = path("recording"), out = path("out");
  const std::string edges = " --plugin " + plugin("edge_detector") + " --set perception.detector=edges";
  expect_success("record forest --seed 1003 --set forest.length_m=5 --quiet --out " + recording + edges);
  const ProgramRun found = expect_success("detect " + recording + " --out " + out + edges);
  expect_part(found.text, "edges");
  EXPECT_EQ(lines_with(found.text, {"detections", "per frame"}), 1) << found.text;
  EXPECT_GT(fs::file_size(fs::path(out) / "points.csv"), 1000u);
  expect_refusal("detect " + recording + " --set perception.detector=true_depth", "looks at no images");
  expect_refusal("evaluate " + recording + " --set perception.detector=none", "must be pushbroom");
}

TEST_F(Plugins, TakePartInCampaigns) {
  const fs::path campaign = folder.write(
      "c.yaml",
      "scenario: clear\nseeds: 1000..1001\noverrides:\n  - {name: ours, set: {forest.length_m: 5}}\n"
      "  - {name: mine, set: {forest.length_m: 5, perception.detector: edges}}\n"
      "  - {name: broken, set: {forest.length_m: 5, perception.detector: throws}}\n");
  const fs::path out = folder.path() / "campaign";
  const ProgramRun flown =
      understory("campaign " + campaign.string() + " --plugin " + plugin("edge_detector") + " --plugin " +
                 plugin("defects") + " --out " + out.string());
  EXPECT_EQ(flown.status, 1) << "two flights failed as machines\n" << flown.text;
  std::ifstream rows(out / "flights.csv");
  const std::string text{std::istreambuf_iterator<char>(rows), {}};
  EXPECT_EQ(lines_with(text, {"mine", "flown"}), 2) << text;
  EXPECT_EQ(lines_with(text, {"broken", "defects.so: detector 'throws': detect() threw: this must not be"}),
            2)
      << text;
}

TEST_F(Plugins, ThatBreakTheirPromisesEndTheFlightAsAFailedMachine) {
  const std::pair<const char*, const char*> cases[] = {
      {"perception.detector=not_finite",
       "detector 'not_finite': detect() gave hit 1 of 1, which is not finite"},
      {"perception.detector=outside", "detector 'outside': detect() gave hit 1 of 1, at column"},
      {"perception.detector=unordered",
       "detector 'unordered': detect() gave hit 2 of 2, above the hit before it"},
      {"perception.detector=throws", "detector 'throws': detect() threw: this must not be"},
      {"autopilot.method=into_the_past", "planner 'into_the_past': plan() gave a plan from"},
      {"autopilot.method=no_plan", "planner 'no_plan': plan() gave a plan with fewer than two points"},
      {"estimation.source=back_in_time",
       "state source 'back_in_time': on() moved the time of the state back"},
      {"course=nowhere", "course 'nowhere': make() gave obstacle 1, which is not finite"}};
  for (const auto& [setting, message] : cases)
    expect_refusal("fly forest --set forest.length_m=5 --set " + std::string(setting) + " --quiet --plugin " +
                       plugin("defects") + " --row " + path("row.json"),
                   message, 3);
}

TEST_F(Plugins, WrongFilesAreOneLine) {
  std::ofstream(folder.path() / "text.so") << "no library";
  // What is cut off may be asked for in flight only.
  const std::string whole = content_of(plugin("edge_detector"));
  for (const std::size_t percent : {60, 90})
    std::ofstream(folder.path() / ("cut" + std::to_string(percent) + ".so"), std::ios::binary)
        << whole.substr(0, whole.size() * percent / 100);
  const std::pair<std::string, const char*> cases[] = {
      {plugin("wrong_no_entry"), "is not a plug-in"},
      {plugin("wrong_stamp"),
       "was built for 'headers of understory 0.0.1: 0123456789abcdef', this program needs"},
      {plugin("wrong_null_stamp"), "was built for 'nothing', this program needs"},
      {plugin("wrong_data_symbol"), "ends the process that loads it"},
      {plugin("wrong_throws_int"), "threw what is no std::exception"},
      {plugin("wrong_exits"), "ends the process that loads it (status 0)"},
      {plugin("wrong_bounds"), "backwards:1: gain: expected a number from 40 to 2, got 3"},
      {path("cut60.so"), "is cut off: its headers speak of"},
      {path("cut90.so"), "is cut off: its headers speak of"},
      {plugin("wrong_symbol"), "a_function_that_nobody_has"},
      {plugin("wrong_name_taken"), "the name 'pushbroom' is taken"},
      {plugin("wrong_name"), "the name 'My Detector' must be letters"},
      {plugin("wrong_key"), "the name 'compute' is taken by the keys perception.compute"},
      {plugin("wrong_throws"), "no licence for"},
      {plugin("wrong_nothing"), "adds no part"},
      {path("text.so"), "text.so"},
      {folder.path().string(), "must be a shared library"},
      {path("none.so"), "No such file"}};
  for (const auto& [file, message] : cases) {
    expect_refusal("plugin " + file, message);
    expect_refusal("fly clear --quiet --plugin " + file, message);
  }
  // The good ones are listed beside a bad one, of whose parts none stays.
  const ProgramRun both = understory("plugin " + plugin("wrong_name_taken") + " " + plugin("edge_detector"));
  EXPECT_EQ(both.status, 2);
  EXPECT_EQ(lines_with(both.text, {"perception.detector=edges"}), 1) << both.text;
  expect_no_part(both.text, "perception.detector=mine");
}

TEST_F(Plugins, OfOursPassEveryCheck) {
  const ProgramRun checked = understory("plugin --check");
  EXPECT_EQ(checked.status, 0) << checked.text;
  expect_part(checked.text, " 0 faults");
}

TEST_F(Plugins, OfTheExamplesPassEveryCheck) {
  const ProgramRun checked =
      understory("plugin --check " + plugin("edge_detector") + " " + plugin("swerve_planner") + " " +
                 plugin("compass_source") + " " + plugin("slalom_course"));
  EXPECT_EQ(checked.status, 0) << checked.text;
  EXPECT_EQ(lines_with(checked.text, {" 0 faults"}), 4) << checked.text;
}

TEST_F(Plugins, DefectsAreFoundByName) {
  // One of them leaks, which is not for the sanitizer to say.
  const ProgramRun checked = understory("plugin --check " + plugin("defects"), "ASAN_OPTIONS=detect_leaks=0");
  EXPECT_EQ(checked.status, 1);
  const std::pair<const char*, const char*> faults[] = {
      {"'unequal'", "equal inputs give equal outputs"},
      {"'disturbed'", "a second instance does not disturb the first"},
      {"'not_finite'", "outputs are finite"},
      {"'outside'", "outputs are finite"},
      {"'unordered'", "outputs are finite"},
      {"'sees_in_the_dark'", "takes a black image"},
      {"'wants_later_times'", "takes a repeated time stamp"},
      {"'slow'", "time of a call"},
      {"'leaky'", "memory does not grow"},
      {"'throws'", "a flight repeats"},
      {"'into_the_past'", "outputs are finite"},
      {"'wants_points'", "takes an empty map"},
      {"'no_plan'", "outputs are finite"},
      {"'back_in_time'", "outputs are finite"},
      {"'another_each_time'", "equal inputs give equal outputs"},
      {"'no_pose'", "outputs are finite"},
      {"'nowhere'", "outputs are finite"},
      {"'sideways_nowhere'", "outputs are finite"},
      {"'huge'", "outputs are finite"}};
  for (const auto& [part, check] : faults)
    EXPECT_EQ(lines_with(checked.text, {part, check, "FAULT"}), 1) << part << " " << check << "\n"
                                                                   << checked.text;
  // A defect is not found where it is not.
  for (const char* part : {"'unequal'", "'leaky'", "'wants_later_times'", "'slow'"})
    EXPECT_EQ(lines_with(checked.text, {part, "outputs are finite", "passed"}), 1) << part;
}

TEST_F(Plugins, ThatEndTheProcessAreNamed) {
  expect_refusal("fly forest --quiet --set perception.detector=exits --plugin " + plugin("blocking") +
                     " --row " + path("row.json"),
                 "blocking.so: detector 'exits': detect(): ended the process", 3);
  EXPECT_FALSE(fs::exists(folder.path() / "row.json"));
}

/// What a command that is ended by the watchdog says, and how.
TEST_F(Plugins, ThatBlockEndTheProgramAndLoseNoFlight) {
  expect_refusal("fly forest --quiet --set perception.detector=blocks --plugin " + plugin("blocking") +
                     " --row " + path("row.json"),
                 "blocking.so: detector 'blocks': detect(): has not returned for 20 s", 3);
  EXPECT_FALSE(fs::exists(folder.path() / "row.json"));
}

}  // namespace
}  // namespace understory::support
