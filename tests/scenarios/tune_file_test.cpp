#include "scenarios/tuning/tune_file.hpp"

#include <gtest/gtest.h>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/scenarios/tuning_cases.hpp"

namespace understory {
namespace {

TEST_F(TuningTest, ReadsWhatIsTunedForWhat) {
  const TuneFile tune = load(tuning_text());
  EXPECT_EQ(tune.name, "t");
  ASSERT_EQ(tune.space.parameters.size(), 2u);
  EXPECT_TRUE(tune.space.parameters[0].whole);
  EXPECT_TRUE(tune.space.parameters[1].logarithmic);
  EXPECT_EQ(tune.scenario_point[0], tune.scenario.perception.pushbroom().minimum_edge_sum);
  EXPECT_EQ(tune.scenario_point[1], tune.scenario.perception.pushbroom().score_limit);
  EXPECT_EQ(tune.figures[tune.objective.goals[0].figure], "mean_speed_mps");
  EXPECT_EQ(tune.objective.limits[0].bound, 0.5);
  EXPECT_EQ(tune.training_seeds, (std::vector<std::uint64_t>{1000, 1001, 1002, 1003}));
  EXPECT_EQ(tune.search.method, SearchMethod::cma_es);
  EXPECT_EQ(
      load(two_keys + "objective: {maximize: success}\nsearch: {method: random, trials: 5}\n" + over_flights)
          .objective.tie_breaker,
      1u);
}

/// A file that is refused, and what the refusal says.
struct BadFile {
  std::string text;
  const char* part;
};

const std::string success = "{maximize: success}", any_search = "{method: random, trials: 5}";

std::string with(const std::string& objective, const std::string& search, const std::string& data) {
  return two_keys + "objective: " + objective + "\nsearch: " + search + "\n" + data;
}

TEST_F(TuningTest, RefusesBadParametersInOneLineWithFileLineAndKey) {
  const auto parameter = [&](const std::string& line) {
    return "scenario: forest\nparameters:\n  " + line + "\nobjective: " + success +
           "\nsearch: " + any_search + "\n" + over_flights;
  };
  const BadFile cases[] = {
      {tuning_text() + "trails: 4\n", "t.yaml:10: trails: unknown key"},
      {tuning_text() + "overs: 4\n", "t.yaml:10: overs: unknown key (did you mean over?)"},
      {"parameters: {}\n", "scenario: expected the scenario whose keys are tuned"},
      {"scenario: wood\n", "t.yaml:1: scenario: wood: expected one of the library"},
      {parameter("perception.pushbroom.scor_limit: {from: 0, to: 1}"),
       "t.yaml:3: parameters.perception.pushbroom.scor_limit: expected a numeric key of the scenario (did "
       "you "
       "mean perception.pushbroom.score_limit?)"},
      {parameter("course: {from: 0, to: 1}"), "t.yaml:3: parameters.course: expected a numeric key"},
      {parameter("seed: {from: 0, to: 1}"), "t.yaml:3: parameters.seed: expected a numeric key"},
      {parameter("perception.pushbroom.minimum_edge_sum: {from: 100, to: 7000}"),
       "t.yaml:3: parameters.perception.pushbroom.minimum_edge_sum.to: expected a whole number from 0 to "
       "6375"},
      {parameter("perception.pushbroom.minimum_edge_sum: {from: 100.5, to: 900}"),
       "minimum_edge_sum.from: expected a whole number"},
      {parameter("perception.pushbroom.score_limit: {from: 0.4, to: 0.1}"),
       "score_limit: from must be less than to"},
      {parameter("perception.pushbroom.score_limit: {from: 0, to: 0.1, scale: log}"),
       "score_limit: scale: log requires from above 0"},
      {parameter("perception.pushbroom.score_limit: {from: 0.1, to: 0.2, scale: lag}"),
       "score_limit.scale: expected linear | log"},
      {parameter("perception.pushbroom.score_limit: {from: 0.1}"),
       "t.yaml:3: parameters.perception.pushbroom.score_limit.to: expected {from: ..., to:"},
      {parameter("perception.pushbroom.score_limit: [0.1, 0.2]"),
       "score_limit: expected {from: ..., to: ..., scale"},
      {parameter("perception.pushbroom.score_limit: {values: [0.1]}"),
       "score_limit.values: must be a list of two"},
      {parameter("perception.pushbroom.score_limit: {values: [0.1, 0.1]}"),
       "score_limit.values: all values must be different"},
  };
  for (const BadFile& one : cases) expect_part(refusal_of(one.text), one.part);
}

TEST_F(TuningTest, RefusesBadObjectivesSearchesAndDataInOneLine) {
  folder.write("seen/a/frames", "");
  folder.write("seen/b/frames", "");
  const std::string recordings = "over: recordings\ntraining: [seen/a]\n";
  const BadFile cases[] = {
      {with("{maximize: speed}", any_search, over_flights),
       "t.yaml:5: objective.maximize: expected one of success, progress"},
      {with("{at_least: {success: 1}}", any_search, over_flights),
       "objective: expected maximize or minimize"},
      {with("{maximize: success, minimize: success}", any_search, over_flights),
       "objective.minimize: this figure is named twice"},
      {with("{maximize: success, at_least: 1}", any_search, over_flights),
       "objective.at_least: expected bounds of figures"},
      {with(success, "{method: best, trials: 5}", over_flights),
       "t.yaml:6: search.method: expected random | grid | cma_es | nsga2"},
      {with(success, "{method: nsga2, trials: 5}", over_flights), "expected cma_es, random or grid where"},
      {with("{maximize: [success, progress]}", "{method: cma_es, trials: 5}", over_flights),
       "expected nsga2, random or grid where"},
      {with(success, "{method: random}", over_flights), "trials: expected a whole number from 1 to"},
      {with(success, "{method: random, trials: 0}", over_flights), "search.trials: expected a whole number"},
      {with(success, "{method: random, trials: 5, sensitivity: 1}", over_flights),
       "search.sensitivity: expected a whole number from 2 to 1000"},
      {with(success, "{method: grid, trials: 9}", over_flights),
       "search.trials: must not be given for a grid"},
      {with(success, "{method: grid}", over_flights),
       "parameters.perception.pushbroom.minimum_edge_sum: expected values, or a range with steps"},
      {with(success, any_search, "over: walks\n"), "t.yaml:7: over: expected recordings | flights"},
      {with(success, any_search, "over: flights\ntraining: 1..5\n"), "validation: expected the seeds"},
      {with(success, any_search, "over: flights\ntraining: 1..5\nvalidation: 5..9\n"),
       "t.yaml:9: validation: seed 5 is a seed of training, too"},
      {with(success, any_search, "over: flights\ntraining: 5..1\nvalidation: 6\n"), "t.yaml:8: training: '"},
      {with("{maximize: recall}", any_search, recordings + "validation: [seen/b, seen/a]\n"),
       "t.yaml:9: validation: "},
      {with("{maximize: recall}", any_search, recordings + "validation: [seen]\n"), "t.yaml:9: validation: "},
      {with("{maximize: recall}", any_search, recordings + "validation: [seen/c]\n"),
       "t.yaml:9: validation: there is no folder seen/c"},
      {with("{maximize: recall}", any_search, recordings + "validation: [seen/b, seen/b]\n"), "given twice"},
      {"scenario: forest\nparameters:\n  forest.length_m: {from: 10, to: 20}\nobjective: {maximize: recall}\n"
       "search: {method: random, trials: 5}\n" +
           recordings + "validation: [seen/b]\n",
       "t.yaml:3: parameters.forest.length_m: expected a key of the scenario's detector, "
       "perception.pushbroom"},
  };
  for (const BadFile& one : cases) expect_part(refusal_of(one.text), one.part);
}

TEST_F(TuningTest, NumbersOfAScenarioHaveTheirBoundsAndEntriesOfListsTheirPlaces) {
  const Scenario scenario = load_scenario(in_library("forest"), {"perception.depths_m=[4.8, 10]"});
  const std::vector<NumericKey> keys = numeric_keys(scenario);
  const auto find = [&](const std::string& key) { return std::ranges::find(keys, key, &NumericKey::key); };
  ASSERT_NE(find("perception.depths_m[1]"), keys.end());
  EXPECT_EQ(find("perception.depths_m[1]")->value, 10);
  EXPECT_EQ(find("perception.depths_m[2]"), keys.end());
  EXPECT_EQ(find("sensors.seed"), keys.end());
  const auto edge = find("perception.pushbroom.minimum_edge_sum");
  ASSERT_NE(edge, keys.end());
  EXPECT_TRUE(edge->whole);
  EXPECT_EQ(edge->maximum, 6375);
  const auto wind = find("wind_world_mps[2]");
  ASSERT_NE(wind, keys.end());
  EXPECT_EQ(wind->minimum, -20);
}

TEST(With, StandsBetweenTheFileAndSettings) {
  const support::TemporaryFolder folder;
  const fs::path first = folder.write("a.yaml", "forest:\n  length_m: 20\n  half_width_m: 12\n");
  const fs::path second = folder.write("b.yaml", "forest:\n  length_m: 30\n");
  const fs::path file = in_library("forest");
  EXPECT_EQ(load_scenario(file, {}, {first}).forest.length_m, 20);
  EXPECT_EQ(load_scenario(file, {}, {first, second}).forest.length_m, 30);
  EXPECT_EQ(load_scenario(file, {}, {first, second}).forest.half_width_m, 12);
  EXPECT_EQ(load_scenario(file, {"forest.length_m=40"}, {first, second}).forest.length_m, 40);
  const fs::path bad = folder.write("c.yaml", "forest:\n  length_m: 20\n  lenght_m: 30\n");
  expect_part(support::refusal_of([&] { load_scenario(file, {}, {bad}); }),
              "c.yaml:3: forest.lenght_m: unknown key");
  expect_part(where_given(file, {}, "forest.length_m", {first, second}), "b.yaml:2");
}

}  // namespace
}  // namespace understory
