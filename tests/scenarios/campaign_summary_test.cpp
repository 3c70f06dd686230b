#include "scenarios/campaign/campaign_summary.hpp"

#include <gtest/gtest.h>

#include "tests/support/flight_rows.hpp"

namespace understory {
namespace {

using support::failed_row;
using support::flown_row;

std::vector<FlightRow> rows() {
  std::vector<FlightRow> all{flown_row("forest", 1, "goal", 75.4), flown_row("forest", 2, "collision", 30),
                             flown_row("dense", 1, "ground", 10),  flown_row("forest", 3, "goal", 75.2),
                             failed_row("forest", 4, "signal 9"),  failed_row("paper", 1, "refused")};
  all[0].planner.obstacle_ahead = 30;
  all[0].planner.obstacle_ahead_ompl = 27;
  all[1].planner.obstacle_ahead = 10;
  all[1].planner.obstacle_ahead_ompl = 3;
  all[1].mean_speed_mps = 10.9;
  return all;
}

TEST(CampaignSummary, CountsEachCondition) {
  const std::vector<ConditionSummary> summaries = summarise(rows());
  ASSERT_EQ(summaries.size(), 3u);
  const ConditionSummary& forest = summaries[0];
  EXPECT_EQ(forest.condition, "forest");
  EXPECT_EQ(forest.flown, 3);
  EXPECT_EQ(forest.goals, 2);
  EXPECT_EQ(forest.collision, 1);
  EXPECT_EQ(forest.failed_to_run, 1);
  EXPECT_NEAR(forest.mean_speed_mps, 11.5, 1e-12);
  EXPECT_NEAR(forest.survival.steps.at(1).share, 2.0 / 3, 1e-12);
  EXPECT_EQ(forest.survival.last_at, 75);
  EXPECT_EQ(summaries[1].ground, 1);
  EXPECT_EQ(summaries[2].flown, 0);
}

TEST(CampaignSummary, PrintsARowPerCondition) {
  const Table table = summary_table(summarise(rows()));
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"forest", "3", "2", "66.7 (20.8 to 93.9)", "1", "0", "0",
                                                     "0", "11.50", "> 75", "0.25", "75.0", "1"}));
  EXPECT_EQ(table.rows[1][9], "10.0");
  EXPECT_EQ(table.rows[2],
            (std::vector<std::string>{"paper", "0", "0", "-", "0", "0", "0", "0", "-", "-", "-", "-", "1"}));
}

}  // namespace
}  // namespace understory
