#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/campaign/campaign_summary.hpp"
#include "tests/support/flight_rows.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

using namespace support;

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

TEST(CampaignSummary, ShowsSharesWithTheirIntervals) {
  const Table table = summary_table(summarise(rows()));
  const auto cell = [&](std::size_t row, const char* column) {
    const auto at =
        std::ranges::find_if(table.head, [&](const std::string& head) { return head.starts_with(column); });
    return table.rows.at(row).at(static_cast<std::size_t>(at - table.head.begin()));
  };
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(cell(0, "success"), "66.7 (20.8 to 93.9)");  // 2 of 3: R's binom::binom.wilson
  EXPECT_EQ(cell(0, "OMPL"), "75.0");                    // (27 + 3) of (30 + 10) replans
  EXPECT_EQ(cell(0, "median"), "> 75");                  // one of three ended before
  EXPECT_EQ(cell(1, "median"), "10.0");
  EXPECT_EQ(cell(2, "success"), "-");  // nothing flown
  EXPECT_EQ(cell(2, "not flown"), "1");
}

/// 9.6 km with eight collisions: 9.6/8, 9.6/15.763 and 9.6/3.454; and a goal, and a flight out of time.
TEST(CampaignSummary, KilometresBetweenCrashes) {
  std::vector<FlightRow> rows;
  for (int seed = 0; seed < 10; ++seed) {
    rows.push_back(flown_row("long", static_cast<std::uint64_t>(seed),
                             seed < 6    ? "collision"
                             : seed == 6 ? "ground"
                             : seed == 7 ? "out_of_bounds"
                             : seed == 8 ? "time"
                                         : "goal"));
    rows.back().among_obstacles_m = 960;
  }
  const CrashDistance distance = crash_distance(summary_of(rows));
  EXPECT_NEAR(distance.value_km, 1.2, 1e-12);
  EXPECT_NEAR(distance.interval.minimum, 0.6090, 5e-5);
  EXPECT_NEAR(distance.interval.maximum, 2.7795, 5e-4);
  EXPECT_EQ(crash_distance_text(summary_of(rows)), "1.2 (0.61 to 2.8)");
  rows.assign(1, flown_row("long", 1, "goal"));
  rows[0].among_obstacles_m = 14800;
  EXPECT_EQ(crash_distance_text(summary_of(rows)), "> 4.0");  // 14.8 / 3.689
  rows[0] = flown_row("long", 1, "collision");
  rows[0].among_obstacles_m = 10;
  EXPECT_EQ(crash_distance_text(summary_of(rows)), "0.01 (0.0018 to 0.39)");  // by 5.572 and 0.02532
  rows[0].among_obstacles_m = 0;
  EXPECT_EQ(crash_distance_text(summary_of(rows)), "-");
}

TEST(CampaignSummary, WhoRunsOutOfTimeStillFlies) {
  std::vector<FlightRow> rows{flown_row("long", 1, "time"), flown_row("long", 2, "goal")};
  EXPECT_FALSE(median_survival(summary_of(rows).survival));
  EXPECT_EQ(summary_of(rows).survival.steps.back().share, 1);
}

const std::string speed_key = "autopilot.flight_model.cruise_speed_mps",
                  density_key = "forest.square_metres_per_tree";

/// Ten flights, `goals` of which reach the goal; the others collide at 10, 20, ... m.
void add_ten(std::vector<FlightRow>& rows, const std::string& condition, double speed_mps, double per_tree_m2,
             int goals) {
  for (int seed = 0; seed < 10; ++seed) {
    const bool good = seed < goals;
    FlightRow row = flown_row(condition, static_cast<std::uint64_t>(seed), good ? "goal" : "collision",
                              good ? 75 : 10 * (seed - goals + 1));
    row.cruise_speed_mps = speed_mps;
    row.square_metres_per_tree = per_tree_m2;
    rows.push_back(row);
  }
}

TEST(CampaignPlots, JoinsConditionsThatDifferInSpeedOnly) {
  std::vector<FlightRow> rows;
  // Names with dashes and signs of equality of their own.
  const std::vector<Condition> conditions{{"a", "", "my-forest", "ours=new", {{speed_key, "12"}}},
                                          {"b", "", "my-forest", "ours=new", {{speed_key, "8"}}},
                                          {"c", "", "my-forest", "blind", {{speed_key, "8"}}},
                                          {"d", "", "my-forest", "blind", {{speed_key, "12"}}},
                                          {"e", "", "dense", "", {}}};
  add_ten(rows, "a", 12, 25, 8);
  add_ten(rows, "b", 8, 25, 10);
  add_ten(rows, "c", 8, 25, 3);
  add_ten(rows, "d", 12, 25, 1);
  add_ten(rows, "e", 10, 25, 5);
  rows.push_back(failed_row("b", 99, "hung"));
  const LinePlot plot = success_over(rows, conditions, axes_of(conditions)[0]);
  ASSERT_EQ(plot.series.size(), 3u);
  EXPECT_EQ(plot.series[0].name, "my-forest, ours=new");
  EXPECT_EQ(plot.series[0].y, (std::vector<double>{100, 80}));
  EXPECT_NEAR(plot.series[0].x[0], 8, 0.1);
  EXPECT_NEAR(plot.series[0].x[1], 12, 0.1);
  EXPECT_NEAR(plot.series[0].low[1], 49.0, 0.05);  // Wilson, 8 of 10
  EXPECT_NEAR(plot.series[0].high[1], 94.3, 0.05);
  EXPECT_EQ(plot.series[2].mark, Mark::dots);
  expect_no_part(campaign_svg(rows, conditions), "density");
  expect_part(campaign_svg(rows, conditions), "success over speed");
}

TEST(CampaignPlots, DensityIsTreesPerHectare) {
  std::vector<FlightRow> rows;
  const std::vector<Condition> conditions{{"a", "", "forest", "", {{density_key, "25"}}},
                                          {"b", "", "forest", "late", {{density_key, "50"}}}};
  add_ten(rows, "a", 10, 25, 5);
  add_ten(rows, "b", 10, 50, 5);
  const LinePlot plot = success_over(rows, conditions, axes_of(conditions)[1]);
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[0].name, "forest");
  EXPECT_NEAR(plot.series[0].x[0], 400, 5);
  EXPECT_EQ(plot.series[1].name, "late");
  EXPECT_NEAR(plot.series[1].x[0], 200, 5);
}

TEST(CampaignPlots, AnyNumericKeyOfTheGridIsAnAxis) {
  const std::string key = "perception.pushbroom.score_limit", word = "perception.preset";
  std::vector<FlightRow> rows;
  const std::vector<Condition> conditions{{"a", "", "forest", "", {{key, "0.3"}, {word, "tuned"}}},
                                          {"b", "", "forest", "", {{key, "0.1"}, {word, "tuned"}}}};
  add_ten(rows, "a", 10, 25, 5);
  add_ten(rows, "b", 10, 25, 9);
  ASSERT_EQ(axes_of(conditions).size(), 3u);
  const LinePlot plot = success_over(rows, conditions, axes_of(conditions)[2]);
  EXPECT_EQ(plot.x_label, key);
  ASSERT_EQ(plot.series.size(), 1u);
  EXPECT_EQ(plot.series[0].x, (std::vector<double>{0.1, 0.3}));
  EXPECT_EQ(plot.series[0].y, (std::vector<double>{90, 50}));
  expect_part(campaign_svg(rows, conditions), "success over score_limit");
}

TEST(CampaignPlots, LongCoursesShowKilometresBetweenCrashes) {
  std::vector<FlightRow> rows;
  const std::vector<Condition> conditions{{"a", "", "forest", "", {{speed_key, "9"}}},
                                          {"b", "", "forest", "", {{speed_key, "12"}}}};
  add_ten(rows, "a", 9, 25, 10);
  add_ten(rows, "b", 12, 25, 5);
  expect_no_part(campaign_svg(rows, conditions), "km between crashes");
  for (FlightRow& row : rows) row.goal_m = 1015, row.among_obstacles_m = 1000;
  const LinePlot plot = crash_distance_over(rows, conditions, axes_of(conditions)[0]);
  ASSERT_EQ(plot.series.size(), 1u);
  EXPECT_TRUE(std::isnan(plot.series[0].y.at(0))) << "no crash, no dot";
  EXPECT_NEAR(plot.series[0].low.at(0), 10 / 3.6889, 1e-4);
  EXPECT_EQ(plot.series[0].high.at(0), HUGE_VAL);
  EXPECT_NEAR(plot.series[0].y.at(1), 2, 1e-12);
  expect_part(campaign_svg(rows, conditions), "km between crashes");
}

TEST(CampaignPlots, WithoutAnAxisConditionsStandSideBySide) {
  std::vector<FlightRow> rows;
  add_ten(rows, "forest-ours", 10, 25, 9);
  add_ten(rows, "forest-blind", 10, 25, 2);
  const std::vector<Condition> conditions{{"forest-ours", "", "forest", "ours", {}},
                                          {"forest-blind", "", "forest", "blind", {}}};
  const LinePlot plot = success_by_condition(rows, conditions);
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.title, "forest: success by condition");
  EXPECT_EQ(plot.series[1].x, std::vector<double>{2});
  EXPECT_EQ(plot.x_names[1], std::pair(2.0, std::string("blind")));
  expect_part(campaign_svg(rows, conditions), "rotate(-90)\" class=\"note\">blind<");
  expect_no_part(campaign_svg(rows, conditions), "km/crash");
  for (FlightRow& row : rows) row.goal_m = 1015;
  expect_part(campaign_svg(rows, conditions), "forest: km/crash by condition");
}

TEST(CampaignPlots, SurvivalGoesDownInSteps) {
  std::vector<FlightRow> rows;
  add_ten(rows, "forest-ours", 10, 25, 8);
  std::vector<Condition> conditions{{"forest-ours", "", "forest", "ours", {}}};
  const std::vector<LinePlot> panels = survival_curves(rows, conditions);
  ASSERT_EQ(panels.size(), 1u);
  EXPECT_EQ(panels[0].title, "forest: survival over distance");
  const Series& series = panels[0].series[0];
  EXPECT_EQ(series.x, (std::vector<double>{0, 10, 10, 20, 20, 75}));
  EXPECT_EQ(series.y.size(), 6u);
  EXPECT_NEAR(series.y[1], 100, 1e-9);
  EXPECT_NEAR(series.y[2], 90, 1e-9);
  EXPECT_NEAR(series.y[5], 80, 1e-9);
  EXPECT_TRUE(series.band);
  for (int more = 0; more < 6; ++more) {
    add_ten(rows, fmt::format("{}", more), 10, 25, more);
    conditions.push_back({fmt::format("{}", more), "", "dense", fmt::format("other{}", more), {}});
  }
  const std::vector<LinePlot> more_panels = survival_curves(rows, conditions);  // each shows one scenario
  ASSERT_EQ(more_panels.size(), 2u);
  EXPECT_EQ(more_panels[1].title, "dense: survival over distance");
  EXPECT_EQ(more_panels[1].series[0].name, "other0");
}

TEST(CampaignPlots, NothingFlownIsNothingDrawn) {
  EXPECT_EQ(campaign_svg({}, {}), "");
  EXPECT_EQ(campaign_svg({failed_row("forest", 1, "hung")}, {}), "");
}

}  // namespace
}  // namespace understory
