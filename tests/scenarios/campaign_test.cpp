#include "scenarios/campaign/campaign_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using support::expect_part;

fs::path library_scenario(const std::string& name) {
  const fs::path file = fs::path(UNDERSTORY_SOURCE_DIR) / "scenarios" / "library" / (name + ".yaml");
  if (!fs::exists(file)) throw ScenarioError(name + ": expected one of the library");
  return file;
}

struct CampaignFile : testing::Test {
  support::TemporaryFolder folder;
  Campaign campaign_of(const std::string& text) const {
    return load_campaign(folder.write("speed.yaml", text), library_scenario);
  }
  std::string refusal_of(const std::string& text) const {
    return support::refusal_of([&] { campaign_of(text); });
  }
};
using CampaignFolders = CampaignFile;

TEST_F(CampaignFile, ScenariosMayFlySeedsOfTheirOwn) {
  const Campaign campaign = campaign_of(
      "{scenarios: [clear, forest], seeds: [3, 5], seeds_apart: 10, overrides: [{name: a}, {name: b}]}");
  std::vector<std::string> flown;
  for (const CampaignTask& task : tasks_of(campaign))
    flown.push_back(task.id + " " + std::to_string(task.seed));
  EXPECT_EQ(flown, (std::vector<std::string>{"clear-a-3 3", "clear-a-5 5", "clear-b-3 3", "clear-b-5 5",
                                             "forest-a-13 13", "forest-a-15 15", "forest-b-13 13",
                                             "forest-b-15 15"}));
}

TEST_F(CampaignFile, FliesEverySeedInEveryConditionOfOverridesAndGrid) {
  const Campaign campaign = campaign_of(
      "scenarios: [forest, dense]\n"
      "seeds: [3, 10..12]\n"
      "overrides:\n"
      "  - name: ours\n"
      "  - {name: blind, set: {perception.detector: none}}\n"
      "grid:\n"
      "  autopilot.flight_model.cruise_speed_mps: [10, 12]\n"
      "timeout_s: 60\n");
  EXPECT_EQ(campaign.name, "speed");
  EXPECT_EQ(campaign.timeout_s, 60);
  EXPECT_EQ(campaign.seeds, (std::vector<std::uint64_t>{3, 10, 11, 12}));
  ASSERT_EQ(campaign.conditions.size(), 8u);
  EXPECT_EQ(campaign.conditions[0].name, "forest-ours-cruise_speed_mps=10");
  EXPECT_EQ(campaign.conditions[3].name, "forest-blind-cruise_speed_mps=12");
  EXPECT_EQ(campaign.conditions[4].name, "dense-ours-cruise_speed_mps=10");
  const Scenario blind = scenario_from_text(campaign.conditions[3].scenario_text, "blind");
  EXPECT_EQ(blind.perception.detector, "none");
  EXPECT_EQ(blind.autopilot.flight_model.cruise_speed_mps, 12);
  const std::vector<CampaignTask> tasks = tasks_of(campaign);
  ASSERT_EQ(tasks.size(), 32u);
  EXPECT_EQ(tasks[1].id, "forest-ours-cruise_speed_mps=10-10");
  EXPECT_EQ(tasks[1].seed, 10u);
  EXPECT_EQ(tasks[31].condition, 7u);
}

TEST_F(CampaignFile, PutsFilesOfKeysUnderItsOwn) {
  const fs::path keys = folder.write("tuned.yaml", "forest: {length_m: 33, half_width_m: 12}\n");
  const auto text = [&](const std::string& file) {
    return "scenario: forest\nseeds: 1\noverrides:\n  - {name: tuned, with: " + file +
           ", set: {forest.half_width_m: 13}}\n";
  };
  const Campaign campaign = campaign_of(text(keys.string()));
  const Scenario tuned = scenario_from_text(campaign.conditions.at(0).scenario_text, "tuned");
  EXPECT_EQ(tuned.forest.length_m, 33);
  EXPECT_EQ(tuned.forest.half_width_m, 13);
  folder.write("tuned.yaml", "forest: {lenght_m: 33}\n");
  expect_part(refusal_of(text(keys.string())), "tuned.yaml:1: forest.lenght_m: unknown key");
  expect_part(refusal_of(text("none.yaml")), "none.yaml: cannot read this");
}

TEST_F(CampaignFile, KeysOverAllConditionsLeaveTheirNames) {
  const fs::path file = folder.write("both.yaml", "scenarios: [forest, dense]\nseeds: 1\n");
  const Campaign plain = load_campaign(file, library_scenario);
  const Campaign changed =
      load_campaign(file, library_scenario, {parse_assignment("autopilot.method=library")});
  ASSERT_EQ(changed.conditions.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(changed.conditions[i].name, plain.conditions[i].name);
    EXPECT_EQ(scenario_from_text(changed.conditions[i].scenario_text, "x").autopilot.method, "library");
  }
  expect_part(
      support::refusal_of([&] { load_campaign(file, library_scenario, {parse_assignment("seed=3")}); }),
      "seed: expected no seed here");
}

TEST_F(CampaignFile, RefusesBadFilesInOneLineWithFileLineAndKey) {
  const struct {
    const char* text;
    const char* part;
  } cases[] = {
      {"scenario: forest\nseeds: 1..3\nsead: 4\n", "speed.yaml:3: sead: unknown key (did you mean seeds?)"},
      {"scenario: forest\nseeds: []\n", "speed.yaml:2: seeds: expected the seeds to fly"},
      {"scenario: forest\nseeds:\n", "speed.yaml:2: seeds: expected the seeds to fly"},
      {"scenario: forest\n", "seeds: expected the seeds to fly"},
      {"scenario: forest\nseeds: 3..1\n", "speed.yaml:2: seeds: '3..1' ends before it begins"},
      {"scenario: forest\nseeds: 1:3\n", "speed.yaml:2: seeds: expected first..last"},
      {"scenario: forest\nseeds: [1..5, 4]\n", "speed.yaml:2: seeds: seed 4 is given twice"},
      {"scenario: forest\nseeds: 0..4000000000\n", "speed.yaml:2: seeds: a campaign may have at most"},
      {"seeds: 1..3\n", "scenarios: expected the scenarios to fly"},
      {"scenarios: [forest, forest]\nseeds: 1\n",
       "speed.yaml:1: scenarios: two conditions are called 'forest"},
      {"scenario: wood\nseeds: 1\n", "speed.yaml:1: scenario: wood: expected one of the library"},
      {"scenario: forest\nseeds: 1\noverrides:\n  - {name: a}\n  - {name: a}\n",
       "two conditions are called 'forest-a'"},
      {"scenario: forest\nseeds: 1\noverrides:\n  - {name: a/b}\n",
       "speed.yaml:4: overrides[0].name: expected a name"},
      {"scenario: forest\nseeds: 1\noverrides: fast\n", "speed.yaml:3: overrides: expected a list"},
      {"scenario: forest\nseeds: 1\noverrides:\n  - {name: a, sets: {}}\n",
       "speed.yaml:4: overrides[0].sets: unknown key"},
      {"scenario: forest\nseeds: 1\ngrid:\n  forest.length_m: 30\n",
       "speed.yaml:4: grid.forest.length_m: expected a list"},
      {"scenario: forest\nseeds: 1\ngrid:\n  forest.lenght_m: [30]\n",
       "speed.yaml:4: grid.forest.lenght_m: unknown key (did you mean forest.length_m?)"},
      {"scenario: forest\nseeds: 1\ngrid:\n  forest.length_m: [30, -1]\n", "speed.yaml:4: forest.length_m"},
      {"scenario: forest\nseeds: 1\ntimeout_s: soon\n", "speed.yaml:3: timeout_s: expected a number from 1"},
      {"scenario: forest\nseeds: 1\nseeds: 2\n", "speed.yaml:3: seeds: this key is given twice"},
  };
  for (const auto& one : cases) expect_part(refusal_of(one.text), one.part);
}

const char* const small_campaign = "scenario: clear\nseeds: 1..2\n";

void prepare(const CampaignFolder& results, const Campaign& campaign, bool resume) {
  FolderMark mark(results.path, campaign_results, results.path);
  prepare_campaign_folder(mark, results, campaign, resume);
}

TEST_F(CampaignFolders, HoldsOneCampaignAndGoesOnWithNoOther) {
  const CampaignFolder results{folder.path() / "results"};
  const Campaign campaign = campaign_of(small_campaign);
  prepare(results, campaign, false);
  EXPECT_THROW(prepare(results, campaign, false), ScenarioError);
  EXPECT_NO_THROW(prepare(results, campaign, true));
  const Campaign held = read_campaign(results);
  EXPECT_EQ(held.seeds, campaign.seeds);
  EXPECT_EQ(held.conditions[0].scenario_text, campaign.conditions[0].scenario_text);
  for (const char* other : {"scenario: clear\nseeds: 1..3\n", "scenario: forest\nseeds: 1..2\n",
                            "scenario: clear\nseeds: 1..2\ntimeout_s: 3\n",
                            "scenario: clear\nseeds: 1..2\ngrid: {time_limit_s: [20]}\n"})
    EXPECT_THROW(prepare(results, campaign_of(other), true), ScenarioError) << other;
  Campaign drawn_otherwise = campaign;
  drawn_otherwise.renderer = "egl";
  EXPECT_THROW(prepare(results, drawn_otherwise, true), ScenarioError);
}

TEST_F(CampaignFolders, OfAnotherFormatIsRefused) {
  const CampaignFolder results{folder.path()};
  folder.write("campaign.json", "{\"format\": 0, \"name\": \"old\"}");
  EXPECT_THROW(read_campaign(results), ScenarioError);
  EXPECT_THROW(prepare(results, campaign_of(small_campaign), true), ScenarioError);
  folder.write("campaign.json", "{\"form");
  EXPECT_THROW(read_campaign(results), ScenarioError);
  folder.write("flights.csv", "seed,outcome\n1,goal\n");
  EXPECT_THROW(read_campaign_rows(folder.path()), ScenarioError);
  EXPECT_THROW(read_campaign_rows(folder.path() / "nowhere"), ScenarioError);
}

FlightRow flown(double clearance_m) {
  FlightRow row;
  row.id = "forest-1";
  row.condition = "forest";
  row.seed = 1;
  row.status = RunStatus::flown;
  row.outcome = "goal";
  row.progress_m = 75.125;
  row.minimum_clearance_m = clearance_m;
  row.detections = 12345678;
  row.digest = "00ff";
  return row;
}

TEST_F(CampaignFolders, CollectsWholeFlightsInTheCampaignsOrder) {
  const CampaignFolder results{folder.path() / "results"};
  const Campaign campaign = campaign_of("scenario: clear\nseeds: [9, 1, 5]\n");
  prepare(results, campaign, false);
  const std::vector<CampaignTask> tasks = tasks_of(campaign);
  write_flight(results, campaign, tasks[1], {flown(0.5), {1.5, 100}});
  EXPECT_EQ(collect(results, campaign).missing, 2u);
  FlightRow hung;
  hung.status = RunStatus::hung;
  hung.reason = "took longer, or \"hung\"\nreally";
  write_flight(results, campaign, tasks[0], {hung, {60, 0}});
  std::ofstream(results.flight_file(tasks[2])) << "{\"format\": 1, \"row\": {\"id\": \"clear-5\", \"see";
  const Collected collected = collect(results, campaign);
  EXPECT_EQ(collected.missing, 1u);  // half a file is none
  ASSERT_EQ(collected.rows.size(), 2u);
  const std::vector<FlightRow> rows = read_campaign_rows(results.path);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].id, "clear-9");
  EXPECT_EQ(rows[0].status, RunStatus::hung);
  EXPECT_EQ(rows[0].reason, hung.reason);  // commas, quotation marks and line breaks come back
  EXPECT_EQ(rows[1].id, "clear-1");
  EXPECT_EQ(rows[1].condition, "clear");
  EXPECT_TRUE(rows[1].reached_goal());
  EXPECT_EQ(rows[1].progress_m, 75.125);
  EXPECT_EQ(rows[1].minimum_clearance_m, 0.5);
  EXPECT_EQ(rows[1].detections, 12345678);
  EXPECT_EQ(rows[1].minimum_points_on_an_obstacle, -1);
  EXPECT_EQ(rows[1].digest, "00ff");
}

TEST(FlightRow, SaysNothingOfWhatWasNotMeasured) {
  const double infinite = std::numeric_limits<double>::infinity();
  const std::string csv = to_csv({flown(infinite)});
  EXPECT_EQ(rows_from_csv(csv, "flights.csv")[0].minimum_clearance_m, infinite);
  expect_part(to_json_line(flown(infinite)), "\"minimum_clearance_m\":null");
  FlightRow crashed;
  crashed.status = RunStatus::crashed;
  expect_part(to_json_line(crashed), "\"outcome\":null");
  EXPECT_THROW(rows_from_csv(csv + "half,a,row\n", "flights.csv"), ScenarioError);
}

}  // namespace
}  // namespace understory
