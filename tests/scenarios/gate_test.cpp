#include <gtest/gtest.h>
#include <algorithm>
#include <limits>
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
            std::vector<std::string>{"forest"});
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

std::vector<std::string> reasons(const std::vector<FlightRow>& baseline,
                                 const std::vector<FlightRow>& candidate, double max_drop = 0.05) {
  return verdict_on(compare_campaigns(baseline, candidate), {max_drop}).reasons;
}

TEST(Gate, TheSameFlightsPass) { EXPECT_TRUE(reasons(hundred(1, 30), hundred(1, 30), 0).empty()); }

TEST(Gate, UnchangedFlightsAreSaidToBeUnchanged) {
  const Comparison same = compare_campaigns(hundred(1, 30), hundred(1, 30));
  const std::string report = to_report(same, verdict_on(same), {});
  expect_part(report, "bit for bit");
  expect_no_part(report, "mean_speed_mps");
}

TEST(Gate, ADropAsLargeAsAllowedPassesOneMoreDoesNot) {
  EXPECT_TRUE(reasons(hundred(1, 0), hundred(1, 5)).empty());
  EXPECT_EQ(reasons(hundred(1, 0), hundred(1, 6)).size(), 1u);
  EXPECT_TRUE(reasons(hundred(1, 10), hundred(6, 20)).empty());
  EXPECT_EQ(reasons(hundred(1, 10), hundred(6, 21)).size(), 1u);
  EXPECT_EQ(reasons(hundred(1, 0), hundred(1, 1), 0).size(), 1u);
}

TEST(Gate, AnyConditionCounts) {
  std::vector<FlightRow> baseline = hundred(1, 0), candidate = hundred(1, 0);
  for (const FlightRow& row : hundred(1, 20, "dense")) baseline.push_back(row);
  for (const FlightRow& row : hundred(1, 28, "dense")) candidate.push_back(row);
  const std::vector<std::string> why = reasons(baseline, candidate);
  ASSERT_EQ(why.size(), 1u);
  EXPECT_EQ(
      why[0],
      "dense: success fell by 8.0 percentage points, from 80 to 72 of 100; at most 5.0 are allowed (p = "
      "0.00781)");
}

TEST(Gate, WhatFailedToRunOrIsMissingDoesNotPass) {
  std::vector<FlightRow> candidate = hundred(1, 0);
  candidate[41] = failed_row("forest", 42, "signal 11: Segmentation fault");
  candidate.pop_back();
  const std::vector<std::string> why = reasons(hundred(1, 0), candidate, 1);
  ASSERT_EQ(why.size(), 2u);
  EXPECT_EQ(why[0], "1 flight of the candidate failed to run: forest-42 (signal 11: Segmentation fault)");
  EXPECT_EQ(why[1], "1 flight of the baseline missing in the candidate: forest-100");
}

TEST(Gate, NothingComparedDoesNotPass) {
  EXPECT_EQ(reasons({}, {}).size(), 1u);
  EXPECT_EQ(reasons({}, hundred(1, 0)).size(), 1u);
  EXPECT_EQ(reasons({failed_row("forest", 1, "hung")}, {flown_row("forest", 1, "goal")}).size(), 1u);
}

TEST(Gate, WhatTheBaselineLacksDecidesNothing) {
  std::vector<FlightRow> candidate = hundred(1, 0);
  candidate.push_back(flown_row("new", 1, "collision", 20));
  EXPECT_TRUE(reasons(hundred(1, 0), candidate).empty());
}

TEST(Gate, TheReportNamesSeedsAndNumbers) {
  const Comparison comparison = compare_campaigns(hundred(1, 3), hundred(3, 9));
  const GateVerdict verdict = verdict_on(comparison, {});
  const std::string report = to_report(comparison, verdict, {});
  for (const char* part :
       {"97 (91.5 to 99.0)", "93 (86.3 to 96.6)", "-4.0", "0.289",
        "mean_speed_mps",  // p: 2 * P(6 of 8 or more)
        "worse: forest: seed 4 (collision at 33.0 m), 5 (",
        "better: forest: seed 1 (collision at 33.0 m), 2 (",
        "passed: 100 flights compared, no condition lost more than 5.0 percentage points\n"})
    expect_part(report, part);
  const GateVerdict strict = verdict_on(comparison, {0.02});
  expect_part(to_report(comparison, strict, {0.02}), "FAILED: forest: success fell by 4.0");
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
  EXPECT_EQ(message(parse(other, text), "forest", "1", "error"), "?[31mred? ? ?? ??? ??");
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
  const pugi::xml_node top = parse(document, gate_junit(compare_campaigns(baseline, candidate)));
  EXPECT_EQ(counts(top), "7 2 2");  // six flights and the condition
  EXPECT_EQ(message(top, "forest", "2", "failure"), "");
  EXPECT_EQ(message(top, "forest", "3", "failure"),
            "collision at 30.0 m of 75.0 m; reached its goal in the baseline");
  EXPECT_EQ(message(top, "forest", "4", "error"), "signal 11");
  EXPECT_EQ(message(top, "forest", "5", "error"), "in the baseline, missing in the candidate");
  EXPECT_EQ(message(top, "gate", "forest", "failure"),
            "success fell from 2 to 1 of 3, by 33.3 percentage points (5.0 allowed), p = 1");

  pugi::xml_document lenient;
  EXPECT_EQ(counts(parse(lenient, gate_junit(compare_campaigns(baseline, candidate), {0.4}))), "7 1 2");
}

TEST(GateJunit, NothingIsStillXml) {
  pugi::xml_document document;
  EXPECT_EQ(counts(parse(document, gate_junit(compare_campaigns({}, {})))), "0 0 0");
}

}  // namespace
}  // namespace understory
