#include "scenarios/tuning/tuning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/tuning/asked_tuning.hpp"
#include "scenarios/tuning/race.hpp"
#include "scenarios/tuning/tune_report.hpp"
#include "tests/scenarios/tuning_cases.hpp"

namespace understory {
namespace {

/// Stands in for flights: closed forms of the two keys. A seed's flight is good where its own limit on the
/// edge sum, 500 + 10 a place, is kept; speed has its maximum at edge 300 and score 0.2, or 0.1 in
/// validation.
class ClosedForm : public Judge {
 public:
  explicit ClosedForm(double best_score) : best_score_(best_score) {}
  int measured = 0;
  int stop_after = 1'000'000;

  Measured measure(const std::string&, const Scenario& scenario, Look look) override {
    if (measured >= stop_after) throw Stopped{};
    ++measured;
    const PushbroomConfig& rule = scenario.perception.pushbroom();
    if (rule.score_limit > 0.35) return {{}, "seed 1000: too much"};
    Measured result;
    for (int i = 0; i < (look == Look::whole ? 20 : 8); ++i)
      result.units.push_back({rule.minimum_edge_sum <= 500 + 10 * i ? 1.0 : 0.0, 0.5,
                              12 - std::pow((rule.minimum_edge_sum - 300) / 100.0, 2) -
                                  std::pow(10 * (rule.score_limit - best_score_), 2) + i,
                              0.25});
    return result;
  }
  Figures figures(std::span<const Counts> units) const override {
    Figures means(4, 0);
    for (const Counts& unit : units)
      for (std::size_t i = 0; i < means.size(); ++i) means[i] += unit[i];
    for (double& mean : means) mean /= static_cast<double>(units.size());
    return means;
  }

 private:
  double best_score_;
};

TEST_F(TuningTest, TrainingChoosesAndValidationIsMeasuredApart) {
  const TuneFile file = load(tuning_text("{method: cma_es, trials: 200, seed: 2}"));
  ClosedForm training(0.2), validation(0.1);
  const Tuned tuned = tune(file, training, validation, {.folder = results("r")});
  EXPECT_EQ(tuned.trials.size(), 201u);
  EXPECT_EQ(tuned.trials[0].point, file.scenario_point);
  EXPECT_TRUE(tuned.keeps_limits);
  const Point& best = tuned.best.training.point;
  EXPECT_NEAR(best[0], 300, 3);
  EXPECT_NEAR(best[1], 0.2, 0.01);
  EXPECT_NEAR(tuned.best.training.figures[2], 12 + 9.5, 0.01);
  EXPECT_NEAR(tuned.best.validation.figures[2], 11 + 9.5, 0.25);  // its own optimum is elsewhere
  // Flights differ among each other, pairs do not: the difference is exactly known.
  const std::vector<FigureChange>& changes = tuned.changes;
  const double difference = tuned.best.validation.figures[2] - tuned.scenario.validation.figures[2];
  EXPECT_NEAR(changes[2].difference, difference, 1e-9);
  EXPECT_NEAR(changes[2].interval.minimum, difference, 1e-9);
  EXPECT_NEAR(changes[2].interval.maximum, difference, 1e-9);
}

/// A figure of 30 units that scatter by the same noise in every trial, less what the trial loses in each; the
/// loss itself scatters by `spread`.
std::vector<Counts> units_losing(double loss, double spread) {
  std::vector<Counts> units;
  for (int i = 0; i < 30; ++i)
    units.push_back({0.5, 0.5, 10 + i % 7 - loss + (i % 2 ? spread : -spread), 0.5});
  return units;
}

TEST(Race, DropsWhatIsClearlyWorseOnTheSameUnitsAndKeepsTheRest) {
  const ClosedForm judge(0.2);
  const Objective faster{.goals = {{2, true}}};
  std::vector<Counts> of_the_rival = units_losing(0, 0);
  Race race(faster, judge, [&](const Trial&) -> const std::vector<Counts>& { return of_the_rival; });
  EXPECT_FALSE(race.dropped(units_losing(1, 0.1)));  // nothing to compare with
  race.add({1, {}, {0.5, 0.5, 13, 0.5}, ""});
  // Units differ by 2 among each other, a pair by 0.1: its mean of 30 by 0.018.
  EXPECT_TRUE(race.dropped(units_losing(0.05, 0.1)));
  EXPECT_FALSE(race.dropped(units_losing(0.03, 0.1)));
  EXPECT_FALSE(race.dropped(units_losing(-1, 0.1)));
  // On all data the rival has 13, whatever the glance shows of it.
  EXPECT_NEAR(race.dropped(units_losing(0.5, 0.1)).value()[2], 12.5, 1e-9);
}

TEST(Race, LimitsDropOnlyWhatMissesThemAndGoalsOnlyWhatIsBetterInNone) {
  const ClosedForm judge(0.2);
  const std::vector<Counts> rival(30, Counts{0.9, 0.5, 10, 0.5});
  const auto race_for = [&](const Objective& objective) {
    Race race(objective, judge, [&](const Trial&) -> const std::vector<Counts>& { return rival; });
    race.add({1, {}, {0.9, 0.5, 10, 0.5}, ""});
    return race;
  };
  const Objective limited{.goals = {{2, true}}, .limits = {{0, true, 0.8}}};
  const auto trial = [](double success, double speed) {
    std::vector<Counts> units(30, Counts{success, 0.5, speed, 0.5});
    units[0][0] -= 0.01, units[1][0] += 0.01, units[0][2] -= 0.01, units[1][2] += 0.01;
    return units;
  };
  EXPECT_TRUE(race_for(limited).dropped(trial(0.7, 20)));
  EXPECT_FALSE(race_for(limited).dropped(trial(0.85, 20)));  // worse than the rival, and allowed
  const Objective both{.goals = {{2, true}, {0, true}}};
  EXPECT_TRUE(race_for(both).dropped(trial(0.8, 9)));
  EXPECT_FALSE(race_for(both).dropped(trial(0.8, 10.1)));
}

TEST_F(TuningTest, ARaceMeasuresFewTrialsWholeAndFindsTheSame) {
  const TuneFile file = load(tuning_text("{method: cma_es, trials: 200, seed: 2}"));
  ClosedForm training(0.2), validation(0.2);
  const Tuned tuned = tune(file, training, validation, {.folder = results("r")});
  const auto dropped = std::ranges::count_if(tuned.trials, &Trial::dropped);
  EXPECT_GT(dropped, 100);
  EXPECT_FALSE(tuned.trials[static_cast<std::size_t>(tuned.best.training.number)].dropped);
  EXPECT_NEAR(tuned.best.training.point[0], 300, 3);
  for (const JudgedTrial& member : tuned.front) EXPECT_FALSE(member.training.dropped);
}

TEST_F(TuningTest, EveryQuestionGetsAnAnswerInJson) {
  const TuneFile file = load(tuning_text("{method: random, trials: 50}"));
  ClosedForm judge(0.2);
  const std::vector<std::string> questions{
      R"({"ask": true})",
      R"({"tell": 1, "figures": {"success": 1, "progress": 1, "mean_speed_mps": 12,)"
      R"( "position_error_m": null}})",
      R"({"tell": 1, "figures": null})",
      R"({"measure": {"perception.pushbroom.score_limit": 0.2}, "data": "validation"})"};
  const std::string bytes = "{}[]\":,0129.-eE+ntrue\\u \x80\xff";
  std::mt19937 generator(1);
  int errors = 0;
  for (int i = 0; i < 4000; ++i) {
    AskedTuning asked(file, [&](bool) -> Judge& { return judge; });
    for (int line = 0; line < 3; ++line) {
      std::string question = questions[generator() % questions.size()];
      for (auto edits = generator() % 4; edits > 0; --edits) {
        const auto at = generator() % question.size();
        if (generator() % 2 == 0)
          question[at] = bytes[generator() % bytes.size()];
        else
          question.erase(at, 1 + generator() % 5);
        question += ' ';
      }
      const auto answer = nlohmann::json::parse(asked.answer(question));
      ASSERT_TRUE(answer.is_object()) << question;
      errors += answer.contains("error");
    }
  }
  EXPECT_GT(errors, 3000);
}

TEST_F(TuningTest, TheBestFewFlyWithTheSameSeeds) {
  TuneFile file = load(tuning_text("{method: cma_es, trials: 60, seed: 2}"));
  file.objective = {.goals = {{2, false}, {0, true}}};
  file.search = {.method = SearchMethod::random, .trials = 60};
  ClosedForm training(0.2), validation(0.2), flights(0.2);
  const Tuned tuned = tune(file, training, validation, {.folder = results("r")}, &flights);
  ASSERT_GE(tuned.flown.size(), 3u);
  EXPECT_EQ(tuned.flown[0].trial.point, file.scenario_point);
  EXPECT_EQ(tuned.flown[1].trial.point, tuned.best.training.point);
  EXPECT_EQ(flights.measured, static_cast<int>(tuned.flown.size()));  // each configuration once
  const PairedOutcomes goals = paired_goals(tuned.flown[0].flights, tuned.flown[1].flights);
  EXPECT_EQ(goals.pairs(), 20);
  write_tune_report(folder.path() / "r", file, tuned, UNDERSTORY_SOURCE_DIR);
  expect_part(content_of(folder.path() / "r/summary.md"), "## In flight");
  expect_part(content_of(folder.path() / "r/report.html"), "In flight.");
}

TEST_F(TuningTest, VariesEachParameterAloneOverItsRange) {
  const TuneFile file = load(tuning_text());
  ClosedForm training(0.2), validation(0.2);
  const Tuned tuned = tune(file, training, validation, {.folder = results("r")});
  ASSERT_EQ(tuned.sensitivity.size(), 2u);
  const Sensitivity& edge = tuned.sensitivity[0];
  EXPECT_EQ(edge.values.front(), 100);
  EXPECT_EQ(edge.values.back(), 900);
  EXPECT_GE(edge.values.size(), 9u);
  for (std::size_t i = 0; i < edge.values.size(); ++i)  // a parabola about 300, whatever the score
    EXPECT_NEAR(
        edge.figures[i][2] - tuned.best.training.figures[2],
        std::pow((tuned.best.training.point[0] - 300) / 100, 2) - std::pow((edge.values[i] - 300) / 100, 2),
        1e-9);
  EXPECT_TRUE(tuned.sensitivity[1].figures.back().empty());  // 0.4: refused

  const TuneFile three = load(tuning_text("{method: cma_es, trials: 60, seed: 2, sensitivity: 3}"));
  const Tuned less = tune(three, training, validation, {.folder = results("three")});
  EXPECT_EQ(less.sensitivity[0].values, (std::vector<double>{100, less.best.training.point[0], 500, 900}));
}

TEST_F(TuningTest, SaysSoWhereNoTrialKeepsTheLimits) {
  TuneFile file = load(tuning_text());
  file.objective.limits[0].bound = 1.5;
  ClosedForm training(0.2), validation(0.2);
  const Tuned tuned = tune(file, training, validation, {.folder = results("r")});
  EXPECT_FALSE(tuned.keeps_limits);
  EXPECT_EQ(tuned.best.training.figures[0], 1);  // misses it by the smallest amount
  expect_part(tune_summary(file, tuned), "No trial of the search keeps the bounds");
}

TEST_F(TuningTest, RecommendsNothingWhereTheScenarioIsAsGoodAsItsBestTrial) {
  TuneFile file = load(tuning_text());
  const auto summary = [&](const fs::path& where) {
    ClosedForm training(0.2), validation(0.2);
    write_tune_report(where, file, tune(file, training, validation, {.folder = where}),
                      UNDERSTORY_SOURCE_DIR);
    return content_of(where / "summary.md");
  };
  expect_no_part(summary(results("r")), "leave it so");
  EXPECT_TRUE(fs::exists(folder.path() / "r/best.yaml"));
  file.scenario_point = {300, 0.2};  // the optimum
  expect_part(summary(results("optimum")), "leave it so");
  EXPECT_FALSE(fs::exists(folder.path() / "optimum/best.yaml"));
}

TEST_F(TuningTest, StoppedAnywhereItEndsWithTheSameLogs) {
  const std::vector<std::string> logs{"trials.jsonl", "validation.jsonl", "sensitivity.jsonl"};
  for (const char* method :
       {"{method: cma_es, trials: 60, seed: 2}", "{method: random, trials: 60, seed: 2}"}) {
    const TuneFile file = load(tuning_text(method));
    const auto run = [&](const fs::path& where, int stop_after = 1'000'000) {
      ClosedForm training(0.2), validation(0.1);
      training.stop_after = stop_after;
      tune(file, training, validation, {.folder = where});
      return training.measured;
    };
    const fs::path undisturbed = results("undisturbed");
    const int all = run(undisturbed);
    const std::string trials = content_of(undisturbed / "trials.jsonl");
    // Whole lines, half a line, nothing; and in the sensitivities.
    for (const std::size_t kept : {std::size_t{0}, trials.size() / 3, trials.size() / 2, trials.size() - 1}) {
      const fs::path stopped = results("stopped");
      folder.write("stopped/trials.jsonl", trials.substr(0, kept));
      EXPECT_THROW(run(stopped, 2), Stopped);
      EXPECT_LE(run(stopped), all);
      for (const std::string& log : logs)
        EXPECT_EQ(content_of(stopped / log), content_of(undisturbed / log)) << kept << log;
      fs::remove_all(stopped);
    }
    EXPECT_EQ(run(undisturbed), 0);  // and measures nothing again
    fs::remove_all(undisturbed);
  }
}

TEST_F(TuningTest, RefusesAnotherTuningsLog) {
  const TuneFile file = load(tuning_text());
  const auto run = [&](const TuneFile& some, const fs::path& where) {
    ClosedForm training(0.2), validation(0.1);
    tune(some, training, validation, {.folder = where});
  };
  const fs::path where = results("r");
  run(file, where);
  EXPECT_THROW(run(load(tuning_text("{method: cma_es, trials: 60, seed: 3}")), where), ScenarioError);
  std::string text = content_of(where / "trials.jsonl");
  text.replace(text.find("score_limit"), 5, "scare");
  folder.write("r/trials.jsonl", text);
  EXPECT_THROW(run(file, where), ScenarioError);
}

TEST_F(TuningTest, AFolderGoesOnOnlyWithItsOwnTuning) {
  const TuneFile file = load(tuning_text());
  const fs::path where = folder.path() / "r";
  const Identity llvmpipe{{"renderer", "llvmpipe"}};
  FolderMark mark(where, tuning_results, where);
  prepare_tune_folder(mark, where, file, false, llvmpipe);
  EXPECT_THROW(prepare_tune_folder(mark, where, file, false, llvmpipe), ScenarioError);
  EXPECT_NO_THROW(prepare_tune_folder(mark, where, file, true, llvmpipe));
  EXPECT_THROW(prepare_tune_folder(mark, where, file, true, {{"renderer", "a GPU"}}), ScenarioError);
  EXPECT_THROW(prepare_tune_folder(mark, where, load(tuning_text() + "timeout_s: 9\n"), true, llvmpipe),
               ScenarioError);
}

TEST_F(TuningTest, LeavesTablesPlotsAndAConfigThatGoesOverTheScenario) {
  const TuneFile file = load(tuning_text());
  ClosedForm training(0.2), validation(0.1);
  const fs::path where = results("r");
  const Tuned tuned = tune(file, training, validation, {.folder = where});
  write_tune_report(where, file, tuned, UNDERSTORY_SOURCE_DIR);
  const Scenario scenario = load_scenario(in_library("forest"), {}, {where / "best.yaml"});
  EXPECT_EQ(scenario.perception.pushbroom().minimum_edge_sum, tuned.best.training.point[0]);
  EXPECT_EQ(scenario.perception.pushbroom().score_limit, tuned.best.training.point[1]);
  EXPECT_EQ(scenario.forest.length_m, file.scenario.forest.length_m);
  const std::string summary = content_of(where / "summary.md");
  for (const char* part : {"| figure | as it is | tuned |", "## Pareto front", "## Sensitivity", "McNemar",
                           "perception.pushbroom.score_limit"})
    expect_part(summary, part);
  const std::string trials = content_of(where / "trials.csv");
  EXPECT_EQ(std::count(trials.begin(), trials.end(), '\n'), 62);  // header, the scenario, 60
  expect_part(content_of(where / "tune.svg"), "front (training)");
  for (const JudgedTrial& member : tuned.front)
    EXPECT_TRUE(fs::exists(where / "front" / ("trial-" + std::to_string(member.training.number) + ".yaml")));
  const std::string pareto = content_of(where / "pareto.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(pareto.begin(), pareto.end(), '\n')), tuned.front.size() + 1);
}

TEST_F(TuningTest, APairedStatementAboutFlightsIsMcNemars) {
  Tuned tuned;
  for (int i = 0; i < 20; ++i) {  // 10 good both times, 6 won, 1 lost, 3 never
    tuned.scenario_units.push_back({i < 11 ? 1.0 : 0.0, 0, 0, 0});
    tuned.best_units.push_back({i < 10 || (i >= 11 && i < 17) ? 1.0 : 0.0, 0, 0, 0});
  }
  const PairedOutcomes goals = paired_goals(tuned.scenario_units, tuned.best_units);
  EXPECT_EQ(goals.both, 10);
  EXPECT_EQ(goals.only_second, 6);
  EXPECT_EQ(goals.only_first, 1);
  EXPECT_EQ(goals.neither, 3);
  EXPECT_NEAR(mcnemar_exact_p(goals), 0.125, 1e-9);  // 2 (1 + 7) / 2^7
}

}  // namespace
}  // namespace understory
