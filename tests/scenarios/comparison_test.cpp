#include "scenarios/campaign/gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scenarios/config/config_tree.hpp"
#include "tests/support/flight_rows.hpp"

namespace understory {
namespace {

using support::failed_row;
using support::flown_row;

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
  baseline[7].min_clearance_m = std::numeric_limits<double>::infinity();
  const ConditionComparison& all = compare_campaigns(baseline, candidate).all;
  // Speeds spread over 30 m/s, differences not at all: only a paired comparison knows half a metre a second.
  EXPECT_EQ(all.metrics[0].name, "mean_speed_mps");
  EXPECT_NEAR(all.metrics[0].difference.value, 0.5, 1e-12);
  EXPECT_NEAR(all.metrics[0].difference.interval.minimum, 0.5, 1e-12);
  EXPECT_EQ(all.metrics[1].name, "min_clearance_m");
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

}  // namespace
}  // namespace understory
