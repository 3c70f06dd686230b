#include "scenarios/campaign/gate.hpp"

#include <gtest/gtest.h>

#include "tests/support/flight_rows.hpp"

namespace understory {
namespace {

using support::failed_row;
using support::flown_row;

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
  return judge(compare_campaigns(baseline, candidate), {max_drop}).reasons;
}

TEST(Gate, TheSameFlightsPass) { EXPECT_TRUE(reasons(hundred(1, 30), hundred(1, 30), 0).empty()); }

TEST(Gate, UnchangedFlightsAreSaidToBeUnchanged) {
  const Comparison same = compare_campaigns(hundred(1, 30), hundred(1, 30));
  const std::string report = to_report(same, judge(same), {});
  EXPECT_NE(report.find("bit for bit"), std::string::npos);
  EXPECT_EQ(report.find("mean_speed_mps"), std::string::npos) << report;
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
  const GateVerdict verdict = judge(comparison, {});
  const std::string report = to_report(comparison, verdict, {});
  for (const char* part :
       {"97 (91.5 to 99.0)", "93 (86.3 to 96.6)", "-4.0", "0.289",
        "mean_speed_mps",  // p: 2 * P(6 of 8 or more)
        "worse: forest: seed 4 (collision at 33.0 m), 5 (",
        "better: forest: seed 1 (collision at 33.0 m), 2 (",
        "passed: 100 flights compared, no condition lost more than 5.0 percentage points\n"})
    EXPECT_NE(report.find(part), std::string::npos) << part << "\n" << report;
  const GateVerdict strict = judge(comparison, {0.02});
  EXPECT_NE(to_report(comparison, strict, {0.02}).find("FAILED: forest: success fell by 4.0"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
