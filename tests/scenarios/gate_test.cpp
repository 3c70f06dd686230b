#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "scenarios/campaign/gate.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/program.hpp"
#include "tests/support/flight_rows.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

using namespace support;

/// Outcomes as in a published paired table (paired_outcomes_test.cpp: 20, 12, 2, 16), shuffled over
/// conditions.
std::vector<FlightRow> cultures(bool second) {
  std::vector<FlightRow> rows;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const bool good = seed < 20 || (second ? seed >= 32 && seed < 34 : seed < 32);
    rows.push_back(
        flown_row(seed % 3 == 0 ? "forest" : "dense", seed, good ? "goal" : "collision", good ? 75 : 40));
  }
  return rows;
}

TEST(Comparison, PairsOutcomesOfTheSameSeed) {
  std::vector<FlightRow> candidate = cultures(true);
  std::ranges::reverse(candidate);
  const Comparison comparison = compare_campaigns(cultures(false), candidate);
  ASSERT_EQ(comparison.conditions.size(), 2u);
  EXPECT_EQ(comparison.conditions[0].condition, "forest");
  EXPECT_EQ(comparison.conditions[0].goals.pairs() + comparison.conditions[1].goals.pairs(), 50);
  const PairedOutcomes& goals = comparison.all.goals;
  EXPECT_EQ(goals.both, 20);
  EXPECT_EQ(goals.only_first, 12);
  EXPECT_EQ(goals.only_second, 2);
  EXPECT_EQ(goals.neither, 16);
  EXPECT_NEAR(comparison.all.p, 0.0129, 5e-5);
  EXPECT_NEAR(goals.difference(), -0.2, 1e-12);
  EXPECT_NEAR(comparison.all.difference.minimum, -0.329207, 5e-7);
  EXPECT_NEAR(comparison.all.difference.maximum, -0.056156, 5e-7);
}

TEST(Comparison, FlightsThatFailedToRunEnterNoFigure) {
  const Comparison comparison = compare_campaigns(
      {flown_row("forest", 1, "goal"), flown_row("forest", 2, "goal"), failed_row("forest", 3, "signal 11")},
      {flown_row("forest", 1, "goal"), failed_row("forest", 2, "signal 6"), flown_row("forest", 3, "goal")});
  EXPECT_EQ(comparison.all.pairs.size(), 3u);
  EXPECT_EQ(comparison.all.goals.pairs(), 1);
  EXPECT_EQ(comparison.all.metrics[0].pairs, 1);
  ASSERT_EQ(comparison.candidate_failed.size(), 1u);
  EXPECT_EQ(comparison.candidate_failed[0].id, "forest-2");
  ASSERT_EQ(comparison.baseline_failed.size(), 1u);
  EXPECT_EQ(comparison.baseline_failed[0].id, "forest-3");
}

TEST(Comparison, ListsFlightsOfOneSide) {
  const Comparison comparison = compare_campaigns(
      {flown_row("forest", 1, "goal"), flown_row("forest", 2, "goal"), flown_row("old", 1, "goal")},
      {flown_row("forest", 1, "goal"), flown_row("new", 1, "goal")});
  ASSERT_EQ(comparison.missing.size(), 2u);
  EXPECT_EQ(comparison.missing[0].id, "forest-2");
  EXPECT_EQ(comparison.missing[1].id, "old-1");
  ASSERT_EQ(comparison.added.size(), 1u);
  EXPECT_EQ(comparison.added[0].id, "new-1");
  EXPECT_EQ(comparison.conditions.size(), 1u);
}

TEST(Comparison, MeansArePaired) {
  std::vector<FlightRow> baseline, candidate;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    baseline.push_back(flown_row("forest", seed, "goal"));
    baseline.back().mean_speed_mps = 10 + static_cast<double>(seed);
    candidate.push_back(baseline.back());
    candidate.back().mean_speed_mps += 0.5;
  }
  baseline[7].minimum_clearance_m = std::numeric_limits<double>::infinity();
  const ConditionComparison& all = compare_campaigns(baseline, candidate).all;
  // Speeds spread over 30 m/s, differences not at all: only a paired comparison knows half a metre a second.
  EXPECT_EQ(all.metrics[0].name, "mean_speed_mps");
  EXPECT_NEAR(all.metrics[0].difference.value, 0.5, 1e-12);
  EXPECT_NEAR(all.metrics[0].difference.interval.minimum, 0.5, 1e-12);
  EXPECT_EQ(all.metrics[1].name, "minimum_clearance_m");
  EXPECT_EQ(all.metrics[1].pairs, 29);
  EXPECT_EQ(all.bit_for_bit, 30);
}

TEST(Comparison, SaysWhereOneNameMeansTwoThings) {
  FlightRow faster = flown_row("forest", 1, "goal");
  faster.cruise_speed_mps = 14;
  EXPECT_EQ(compare_campaigns({flown_row("forest", 1, "goal")}, {faster}).altered,
            std::vector<std::string>{"forest: cruise speed 14 m/s instead of 12 m/s"});
}

TEST(Comparison, RefusesAFlightTwice) {
  const std::vector<FlightRow> twice{flown_row("forest", 1, "goal"), flown_row("forest", 1, "time")};
  EXPECT_THROW(compare_campaigns(twice, {}), ScenarioError);
  EXPECT_THROW(compare_campaigns({}, twice), ScenarioError);
}

/// Seeds 1 to 100 of which those from `first` to `last` collide at 33 m.
std::vector<FlightRow> hundred(std::uint64_t first, std::uint64_t last,
                               const std::string& condition = "forest") {
  std::vector<FlightRow> rows;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const bool collides = seed >= first && seed <= last;
    rows.push_back(flown_row(condition, seed, collides ? "collision" : "goal", collides ? 33 : 75));
  }
  return rows;
}

GateVerdict judged(const std::vector<FlightRow>& baseline, const std::vector<FlightRow>& candidate,
                   const GateRule& rule = {}) {
  return verdict_on(compare_campaigns(baseline, candidate), rule);
}

/// Other digests than those of another side with the same outcomes.
std::vector<FlightRow> altered(std::vector<FlightRow> rows) {
  for (FlightRow& row : rows) row.digest += "-altered";
  return rows;
}

TEST(Gate, EqualFlightsAreUnchangedAndBoundOtherSeeds) {
  const GateVerdict verdict = judged(hundred(1, 30), hundred(1, 30));
  EXPECT_EQ(verdict.verdict, Verdict::unchanged);
  EXPECT_NEAR(verdict.changed_at_most, 1 - std::pow(0.05, 0.01), 1e-12);  // the rule of three, of 100 seeds
  EXPECT_EQ(judged(hundred(1, 30), altered(hundred(1, 30))).verdict, Verdict::not_worse);
}

/// The verdicts of n pairs of which so many got worse or better.
Verdict verdict_of(std::uint64_t pairs, std::uint64_t worse, std::uint64_t better, double margin = 0.05) {
  std::vector<FlightRow> baseline, candidate;
  for (std::uint64_t seed = 0; seed < pairs; ++seed) {
    baseline.push_back(flown_row("forest", seed, seed >= worse && seed < worse + better ? "time" : "goal"));
    candidate.push_back(flown_row("forest", seed, seed < worse ? "collision" : "goal"));
  }
  return judged(baseline, altered(candidate), {.margin = margin}).verdict;
}

TEST(Gate, VerdictsFollowTheEvidence) {
  EXPECT_EQ(verdict_of(40, 0, 0), Verdict::undecided);  // 40 pairs can never show 5 %
  EXPECT_EQ(verdict_of(100, 0, 0), Verdict::not_worse);
  EXPECT_EQ(verdict_of(100, 2, 2), Verdict::undecided);
  EXPECT_EQ(verdict_of(300, 6, 6), Verdict::not_worse);
  EXPECT_EQ(verdict_of(100, 9, 0), Verdict::worse);
  EXPECT_EQ(verdict_of(100, 3, 0), Verdict::undecided);
  EXPECT_EQ(verdict_of(2000, 60, 20), Verdict::not_worse);  // a fall of 2 % is proved, and smaller than 5 %
  EXPECT_EQ(verdict_of(2000, 60, 20, 0.02), Verdict::worse);
}

/// What is asked for brings the verdict if the rest comes out like these.
TEST(Gate, SaysHowManyMoreFlightsDecide) {
  for (const auto& [worse, better] : {std::pair(0, 0), {2, 2}, {1, 0}, {3, 1}}) {
    std::vector<FlightRow> baseline, candidate;
    const auto fly = [&](int count) {
      for (int i = 0; i < count; ++i) {
        const int at = static_cast<int>(baseline.size()), of_fifty = at % 50;
        const auto seed = static_cast<std::uint64_t>(at);
        const bool gains = of_fifty >= worse && of_fifty < worse + better;
        baseline.push_back(flown_row("forest", seed, gains ? "time" : "goal"));
        candidate.push_back(flown_row("forest", seed, of_fifty < worse ? "collision" : "goal"));
      }
      return judged(baseline, altered(candidate));
    };
    const GateVerdict before = fly(50);
    ASSERT_EQ(before.verdict, Verdict::undecided);
    ASSERT_GT(before.more_pairs, 0);
    EXPECT_NE(fly((before.more_pairs + 49) / 50 * 50).verdict, Verdict::undecided) << worse << " " << better;
  }
}

/// Three fifths of the flights of one forest of twenty: over all a fall by 3 %, below the margin.
TEST(Gate, AForestThatBreaksIsFoundAmongTwenty) {
  std::vector<FlightRow> baseline, candidate;
  for (int condition = 0; condition < 20; ++condition)
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      baseline.push_back(flown_row("forest" + std::to_string(condition), seed, "goal"));
      candidate.push_back(baseline.back());
      if (condition == 7 && seed < 15) candidate.back().outcome = "collision";
    }
  const GateVerdict verdict = judged(baseline, altered(candidate));
  EXPECT_EQ(verdict.verdict, Verdict::worse);
  ASSERT_EQ(verdict.reasons.size(), 1u);
  EXPECT_EQ(verdict.reasons[0], "forest7: success fell by 60.0 percentage points, from 25 to 10 of 25");
}

/// The stated net loss is the first that is called worse.
TEST(Gate, SaysWhichNetLossWouldBeCalledWorse) {
  const GateVerdict verdict = judged(hundred(1, 0), altered(hundred(1, 2)));
  const auto lost = static_cast<std::uint64_t>(std::lround(100 * verdict.smallest_shown));
  EXPECT_EQ(judged(hundred(1, 0), altered(hundred(1, lost))).verdict, Verdict::worse);
  EXPECT_NE(judged(hundred(1, 0), altered(hundred(1, lost - 1))).verdict, Verdict::worse);
}

TEST(Gate, WhatFailedToRunOrIsMissingDoesNotPass) {
  std::vector<FlightRow> candidate = hundred(1, 0);
  candidate[41] = failed_row("forest", 42, "signal 11: Segmentation fault");
  candidate.pop_back();
  const GateVerdict verdict = judged(hundred(1, 0), candidate, {.margin = 0.5});
  EXPECT_EQ(verdict.verdict, Verdict::worse);
  ASSERT_EQ(verdict.reasons.size(), 2u);
  EXPECT_EQ(verdict.reasons[0],
            "1 flight of the candidate failed to run: forest-42 (signal 11: Segmentation fault)");
  EXPECT_EQ(verdict.reasons[1], "1 flight of the baseline missing in the candidate: forest-100");
}

TEST(Gate, NothingComparedDoesNotPass) {
  for (const auto& [baseline, candidate] :
       {std::pair<std::vector<FlightRow>, std::vector<FlightRow>>{},
        {{}, hundred(1, 0)},
        {{failed_row("forest", 1, "hung")}, {flown_row("forest", 1, "goal")}}}) {
    const GateVerdict verdict = judged(baseline, candidate);
    EXPECT_EQ(verdict.verdict, Verdict::worse);
    EXPECT_EQ(verdict.reasons.size(), 1u);
  }
}

TEST(Gate, WhatTheBaselineLacksDecidesNothing) {
  std::vector<FlightRow> candidate = hundred(1, 0);
  candidate.push_back(flown_row("new", 1, "collision", 20));
  EXPECT_EQ(judged(hundred(1, 0), candidate).verdict, Verdict::unchanged);
}

TEST(Gate, OtherPicturesLeaveOutcomesAlone) {
  const std::vector<FlightRow> rows = hundred(1, 30);
  const Comparison comparison = compare_campaigns(rows, rows, "plain scenery is drawn with pictures a, b");
  EXPECT_EQ(comparison.all.bit_for_bit, 0);
  EXPECT_EQ(verdict_on(comparison).verdict, Verdict::not_worse);
  expect_part(to_report(comparison, verdict_on(comparison), {}), "outcomes alone are compared");
  Campaign here, elsewhere;
  EXPECT_FALSE(drawn_differently(here, elsewhere));  // both are older
  here.pictures = {{"plain", "1"}};
  elsewhere.pictures = {{"woods", "2"}, {"plain", "1"}};
  EXPECT_EQ(drawn_differently(here, elsewhere), "");
  elsewhere.pictures[1].second = "3";
  expect_part(drawn_differently(here, elsewhere).value(), "pictures 1 in the baseline, 3 in the candidate");
}

TEST(Gate, ATolerancesLossIsJudged) {
  const std::vector<FlightRow> rows = hundred(1, 0);
  std::vector<FlightRow> slower = altered(rows);
  for (FlightRow& row : slower) row.mean_speed_mps -= 0.4 + 0.001 * static_cast<double>(row.seed);
  const auto verdict = [&](const char* figure, double loss) {
    return judged(rows, slower, {.tolerances = {{figure, loss}}}).verdict;
  };
  EXPECT_EQ(verdict("mean_speed_mps", 0.3), Verdict::worse);
  EXPECT_EQ(verdict("mean_speed_mps", 0.45), Verdict::undecided);  // it is 0.4505, spread over 0.1
  EXPECT_EQ(verdict("mean_speed_mps", 0.6), Verdict::not_worse);
  EXPECT_EQ(verdict("progress_m", 0), Verdict::undecided);  // all equal: no loss below nothing is excluded
  EXPECT_THROW(require_known_figures({.tolerances = {{"speed", 1}}}), ScenarioError);
}

TEST(Gate, ThePlansPairsBringTheVerdict) {
  const int planned = planned_pairs(0.04, 0.8, {});
  EXPECT_GT(planned, 100);
  EXPECT_LT(planned, 400);
  EXPECT_GT(planned_pairs(0.04, 0.95, {}), planned);
  EXPECT_GT(planned_pairs(0.10, 0.8, {}), planned);
  EXPECT_EQ(planned_pairs(0, 0.8, {}), 90);  // (1 - 0.05)^-n, a twentieth of the money on each bet
}

TEST(Gate, TheReportNamesSeedsAndNumbers) {
  const Comparison comparison = compare_campaigns(hundred(1, 3), altered(hundred(3, 9)));
  const GateVerdict verdict = verdict_on(comparison, {});
  const std::string report = to_report(comparison, verdict, {});
  for (const char* part : {"97 (91.5 to 99.0)", "93 (86.3 to 96.6)", "-4.0", "0.289",
                           "mean_speed_mps",  // p: 2 * P(6 of 8 or more)
                           "worse: forest: seed 4 (collision at 33.0 m), 5 (",
                           "better: forest: seed 1 (before: collision at 33.0 m), 2 (",
                           "not enough flights: after 100 pairs success may have fallen by "})
    expect_part(report, part);
  const auto command = [](const FlightRow& row) {
    return "understory fly forest --seed " + std::to_string(row.seed);
  };
  const GateSides sides{"before", "after", "gate.html", command};
  const std::string comment = to_markdown(comparison, verdict, {}, sides);
  EXPECT_EQ(comment.find("### Flights: not enough flights\n\nNot enough flights: "), 0u) << comment;
  expect_part(
      comment,
      "- forest 4: collision at 33.0 m; `understory fly forest --seed 4`; replay: gate.html#forest-4");
  const auto json = nlohmann::json::parse(to_json(comparison, verdict, {}, sides));
  EXPECT_EQ(json["verdict"], "not enough flights");
  EXPECT_EQ(json["conditions"][0]["got_worse"][0]["command"], "understory fly forest --seed 4");
  EXPECT_EQ(json["all"]["worse"], 6);
  EXPECT_EQ(json["all"]["baseline_km"]["crashes"], 3);
  EXPECT_EQ(json["conditions"][0]["candidate_km"]["crashes"], 7);
  EXPECT_NEAR(json["all"]["difference"].get<double>(), -0.04, 1e-12);
}

pugi::xml_node parse(pugi::xml_document& document, const std::string& text) {
  const pugi::xml_parse_result result = document.load_string(text.c_str());
  EXPECT_TRUE(result) << result.description() << "\n" << text;
  return document.child("testsuites");
}

std::string counts(const pugi::xml_node& node) {
  return std::string(node.attribute("tests").value()) + " " + node.attribute("failures").value() + " " +
         node.attribute("errors").value();
}

std::string message(const pugi::xml_node& top, const std::string& suite, const std::string& name,
                    const char* kind) {
  return top.find_child_by_attribute("testsuite", "name", suite.c_str())
      .find_child_by_attribute("testcase", "name", name.c_str())
      .child(kind)
      .attribute("message")
      .value();
}

TEST(CampaignJunit, IsACasePerFlight) {
  pugi::xml_document document;
  const pugi::xml_node top = parse(
      document, campaign_junit({flown_row("forest", 1, "goal"), flown_row("forest", 2, "collision", 31.25),
                                flown_row("dense", 1, "time", 12),
                                failed_row("forest", 3, "hung after 300 s", RunStatus::hung)}));
  EXPECT_EQ(counts(top), "4 2 1");
  const pugi::xml_node forest = top.first_child();
  EXPECT_STREQ(forest.attribute("name").value(), "forest");
  EXPECT_EQ(counts(forest), "3 1 1");
  EXPECT_STREQ(forest.attribute("time").value(), "13.800");
  EXPECT_STREQ(forest.child("properties").child("property").attribute("value").value(), understory_version);
  EXPECT_STREQ(forest.child("testcase").attribute("classname").value(), "forest");
  EXPECT_STREQ(forest.child("testcase").attribute("time").value(), "6.900");
  EXPECT_TRUE(forest.child("testcase").first_child().empty());
  EXPECT_EQ(message(top, "forest", "2", "failure"), "collision at 31.2 m of 75.0 m");
  EXPECT_EQ(message(top, "forest", "3", "error"), "hung after 300 s");
  EXPECT_EQ(message(top, "dense", "1", "failure"), "time at 12.0 m of 75.0 m");
}

TEST(CampaignJunit, OddCharactersComeBackOrBecomeQuestionMarks) {
  const std::string odd = "<a href=\"x\">&'\xc3\xa9\xe2\x82\xac</a>";
  pugi::xml_document document;
  const pugi::xml_node top = parse(document, campaign_junit({failed_row("forest", 1, odd)}));
  EXPECT_EQ(message(top, "forest", "1", "error"), odd);

  // A terminal's colours, a lone byte, an overlong slash, a surrogate, a letter cut off: none is XML.
  const std::string broken = "\x1b[31mred\x01 \xff \xc0\xaf \xed\xa0\x80 \xe2\x82";
  pugi::xml_document other;
  const std::string text = campaign_junit({failed_row("forest", 1, broken)});
  EXPECT_EQ(message(parse(other, text), "forest", "1", "error"), "?[31mred? ? ?? ??? ?");
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7f)) << static_cast<int>(c);
}

TEST(GateJunit, FailsWhatGotWorse) {
  const std::vector<FlightRow> baseline{
      flown_row("forest", 1, "goal"), flown_row("forest", 2, "collision", 20), flown_row("forest", 3, "goal"),
      flown_row("forest", 4, "goal"), flown_row("forest", 5, "goal")};
  const std::vector<FlightRow> candidate{flown_row("forest", 1, "goal"), flown_row("forest", 2, "ground", 25),
                                         flown_row("forest", 3, "collision", 30),
                                         failed_row("forest", 4, "signal 11"),
                                         flown_row("forest", 6, "collision", 5)};
  pugi::xml_document document;
  const Comparison comparison = compare_campaigns(baseline, candidate);
  GateVerdict verdict = verdict_on(comparison);
  const pugi::xml_node top = parse(document, gate_junit(comparison, verdict));
  EXPECT_EQ(counts(top), "7 2 2");  // six flights and the verdict
  EXPECT_EQ(message(top, "forest", "2", "failure"), "");
  EXPECT_EQ(message(top, "forest", "3", "failure"),
            "collision at 30.0 m of 75.0 m; reached its goal in the baseline");
  EXPECT_EQ(message(top, "forest", "4", "error"), "signal 11");
  EXPECT_EQ(message(top, "forest", "5", "error"), "in the baseline, missing in the candidate");
  EXPECT_EQ(message(top, "gate", "verdict", "failure"),
            "worse: 1 flight of the candidate failed to run: forest-4 (signal 11); 1 flight of the baseline "
            "missing "
            "in the candidate: forest-5");

  verdict.verdict = Verdict::not_worse;  // a server that counts failures agrees with a verdict that passes
  pugi::xml_document passed;
  EXPECT_EQ(counts(parse(passed, gate_junit(comparison, verdict))), "7 0 2");
}

}  // namespace
}  // namespace understory
