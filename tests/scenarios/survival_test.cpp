#include "scenarios/statistics/survival.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace understory {
namespace {

/// Weeks of remission in acute leukaemia (Freireich et al. 1963, Blood 21, 699), as in Cox & Oakes 1984 and
/// in Kleinbaum & Klein; true: relapsed.
const std::vector<Lifetime> mercaptopurine{
    {6, true},   {6, true},   {6, true},   {6, false},  {7, true},   {9, false},  {10, true},
    {10, false}, {11, false}, {13, true},  {16, true},  {17, false}, {19, false}, {20, false},
    {22, true},  {23, true},  {25, false}, {32, false}, {32, false}, {34, false}, {35, false}};

std::vector<Lifetime> placebo() {
  std::vector<Lifetime> lifetimes;
  for (const double weeks : {1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23})
    lifetimes.push_back({weeks, true});
  return lifetimes;
}

// Venables & Ripley, Modern Applied Statistics with S, 4th edition, 13.1: the same data (there: gehan), with
// log-log intervals.
TEST(KaplanMeier, PublishedCurve) {
  const struct {
    double at;
    int at_risk, ended;
    double share, standard_error, minimum, maximum;
  } rows[] = {{6, 21, 3, 0.857, 0.0764, 0.620, 0.952},  {7, 17, 1, 0.807, 0.0869, 0.563, 0.923},
              {10, 15, 1, 0.753, 0.0963, 0.503, 0.889}, {13, 12, 1, 0.690, 0.1068, 0.432, 0.849},
              {16, 11, 1, 0.627, 0.1141, 0.368, 0.805}, {22, 7, 1, 0.538, 0.1282, 0.268, 0.747},
              {23, 6, 1, 0.448, 0.1346, 0.188, 0.680}};
  const SurvivalCurve curve = kaplan_meier(mercaptopurine);
  ASSERT_EQ(curve.steps.size(), 8u);
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    const SurvivalStep& step = curve.steps[i + 1];
    EXPECT_EQ(step.at, rows[i].at);
    EXPECT_EQ(step.at_risk, rows[i].at_risk);
    EXPECT_EQ(step.ended, rows[i].ended);
    EXPECT_NEAR(step.share, rows[i].share, 5e-4);
    EXPECT_NEAR(step.standard_error, rows[i].standard_error, 5e-5);
    EXPECT_NEAR(step.interval.minimum, rows[i].minimum, 5e-4);
    EXPECT_NEAR(step.interval.maximum, rows[i].maximum, 5e-4);
  }
  EXPECT_EQ(curve.last_at, 35);
}

// Kleinbaum & Klein, Survival Analysis, chapter 2: median remission 23 weeks and 8 weeks; log-rank 16.79,
// expected relapses 19.25 and 10.75.
TEST(KaplanMeier, PublishedMedians) {
  EXPECT_EQ(median_survival(kaplan_meier(mercaptopurine)), 23);
  EXPECT_EQ(median_survival(kaplan_meier(placebo())), 8);
}

TEST(LogRank, PublishedTest) {
  const LogRank test = log_rank(mercaptopurine, placebo());
  EXPECT_NEAR(test.expected_first, 19.25, 5e-3);
  EXPECT_NEAR(test.expected_second, 10.75, 5e-3);
  EXPECT_NEAR(test.chi_square, 16.79, 5e-3);
  EXPECT_NEAR(test.p, 4.17e-5, 5e-7);
  EXPECT_DOUBLE_EQ(log_rank(placebo(), mercaptopurine).chi_square, test.chi_square);
}

TEST(LogRank, NothingHappened) {
  EXPECT_EQ(log_rank({{1, false}, {2, false}}, {{3, false}}).p, 1);
  EXPECT_EQ(log_rank({}, {{3, true}}).p, 1);
}

/// Without censoring the curve is the plain share and its error the binomial one.
TEST(KaplanMeier, WithoutCensoringItIsAShare) {
  for (const SurvivalStep& step : kaplan_meier(placebo()).steps) {
    int beyond = 0;
    for (const Lifetime& lifetime : placebo()) beyond += lifetime.at > step.at ? 1 : 0;
    EXPECT_NEAR(step.share, beyond / 21.0, 1e-12);
    EXPECT_NEAR(step.standard_error, std::sqrt(step.share * (1 - step.share) / 21), 1e-12);
  }
}

TEST(KaplanMeier, TheEndsOfWhatCanBeSaid) {
  const SurvivalCurve nobody = kaplan_meier({});
  EXPECT_EQ(nobody.steps.size(), 1u);
  EXPECT_EQ(nobody.steps[0].interval.minimum, 0);

  const SurvivalCurve all_well = kaplan_meier({{75, false}, {75, false}});
  EXPECT_EQ(survival_at(all_well, 75).share, 1);
  EXPECT_NEAR(survival_at(all_well, 75).interval.minimum, 0.3424, 5e-5);  // Wilson, 2 of 2
  EXPECT_FALSE(median_survival(all_well));

  const SurvivalCurve all_gone = kaplan_meier({{10, true}, {20, true}});
  EXPECT_EQ(survival_at(all_gone, 9.9).share, 1);
  EXPECT_EQ(survival_at(all_gone, 10).share, 0.5);
  EXPECT_EQ(survival_at(all_gone, 300).share, 0);
  EXPECT_EQ(survival_at(all_gone, 300).interval.minimum, 0);
  EXPECT_EQ(survival_at(all_gone, 300).interval.maximum, survival_at(all_gone, 10).interval.maximum);
  EXPECT_EQ(median_survival(all_gone), 10);
}

}  // namespace
}  // namespace understory
