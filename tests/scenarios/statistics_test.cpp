#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenarios/statistics/sequential.hpp"

namespace understory {
namespace {

// Newcombe 1998, Statistics in Medicine 17, table I, method 3 (score, no continuity correction), 95 %.
TEST(Wilson, PublishedValues) {
  const struct {
    int successes, trials;
    double minimum, maximum;
  } rows[] = {
      {81, 263, 0.2553, 0.3662}, {15, 148, 0.0624, 0.1605}, {0, 20, 0.0000, 0.1611}, {1, 29, 0.0061, 0.1718}};
  for (const auto& row : rows) {
    const Interval interval = wilson_interval(row.successes, row.trials);
    EXPECT_NEAR(interval.minimum, row.minimum, 5e-5);
    EXPECT_NEAR(interval.maximum, row.maximum, 5e-5);
  }
}

TEST(Wilson, StaysWithinZeroAndOne) {
  EXPECT_NEAR(wilson_interval(100, 100).maximum, 1, 1e-12);
  EXPECT_NEAR(wilson_interval(100, 100).minimum, 0.9630, 5e-5);
  EXPECT_EQ(wilson_interval(0, 0).minimum, 0);
  EXPECT_EQ(wilson_interval(0, 0).maximum, 1);
}

// Garwood 1936, Biometrika 28, 437, as tabulated by Ulm 1990, American Journal of Epidemiology 131, 373.
TEST(Poisson, PublishedIntervals) {
  const struct {
    int events;
    double minimum, maximum;
  } rows[] = {
      {0, 0, 3.6889}, {1, 0.0253, 5.5716}, {5, 1.6235, 11.6683}, {8, 3.4538, 15.7632}, {10, 4.7954, 18.3904}};
  for (const auto& row : rows) {
    EXPECT_NEAR(poisson_interval(row.events).minimum, row.minimum, 5e-5);
    EXPECT_NEAR(poisson_interval(row.events).maximum, row.maximum, 5e-5);
  }
}

/// Armitage & Berry 1994, Statistical Methods in Medical Research, p. 127: growth on two media, 50 specimens.
const PairedOutcomes cultures{20, 12, 2, 16};
/// Bentur et al. 2009, as in Fagerland, Lydersen & Laake 2013, BMC Medical Research Methodology 13:91,
/// table 1.
const PairedOutcomes airways{1, 1, 7, 12};

TEST(McNemar, PublishedTables) {
  EXPECT_NEAR(mcnemar_exact_p(cultures), 0.0129, 5e-5);  // StatsDirect's manual on the same table
  EXPECT_NEAR(mcnemar_exact_p(airways), 0.0703, 5e-5);   // Fagerland et al.: 0.070
}

TEST(McNemar, OnlyChangedPairsCount) {
  EXPECT_EQ(mcnemar_exact_p({7, 0, 0, 3}), 1);
  EXPECT_EQ(mcnemar_exact_p({0, 0, 0, 0}), 1);
  EXPECT_EQ(mcnemar_exact_p({1, 4, 4, 1}), 1);
  EXPECT_NEAR(mcnemar_exact_p({0, 5, 0, 0}), 0.0625, 1e-12);
  EXPECT_EQ(mcnemar_exact_p({0, 5, 1, 0}), mcnemar_exact_p({100, 1, 5, 100}));
}

// Newcombe 1998, Statistics in Medicine 17, 2635, method 10; Fagerland, Lydersen & Laake 2014, Statistics in
// Medicine 33, 2850 (-0.507 to -0.026, as first less second); StatsDirect's manual on paired proportions.
TEST(PairedDifference, PublishedIntervals) {
  const struct {
    PairedOutcomes outcomes;
    double minimum, maximum;  ///< of first less second, as published
    double within;
  } rows[] = {{{36, 12, 2, 0}, 0.0569, 0.3404, 5e-5},
              {airways, -0.507, -0.026, 5e-4},
              {cultures, 0.056156, 0.329207, 5e-7}};
  for (const auto& row : rows) {
    const Interval interval = paired_difference_interval(row.outcomes);
    EXPECT_NEAR(-interval.maximum, row.minimum, row.within);
    EXPECT_NEAR(-interval.minimum, row.maximum, row.within);
  }
}

TEST(PairedDifference, Edges) {
  EXPECT_EQ(paired_difference_interval({}).minimum, -1);
  EXPECT_EQ(paired_difference_interval({}).maximum, 1);
  const Interval same = paired_difference_interval({100, 0, 0, 0});
  EXPECT_LT(same.minimum, 0);
  EXPECT_NEAR(same.maximum, -same.minimum, 1e-12);
  EXPECT_NEAR(paired_difference_interval({0, 10, 0, 0}).minimum, -1, 1e-12);
}

TEST(Quantile, IsTheNearestRank) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2}, 0.99), 3);
  EXPECT_EQ(quantile({3, 1, 2}, 0), 1);
  std::vector<double> hundred(100);
  for (int i = 0; i < 100; ++i) hundred[static_cast<std::size_t>(i)] = 100 - i;
  EXPECT_EQ(quantile(hundred, 0.99), 99);
}

double variance(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size());
}

// Efron & Tibshirani 1993, An Introduction to the Bootstrap, tables 14.1 and 14.2: the spatial test's A
// values; their variance (171.5) has the 90 % BCa interval 115.8 to 259.6, of 2000 resamples, which leaves an
// upper end uncertain by some 5.
TEST(Bootstrap, PublishedBcaInterval) {
  const std::vector<double> spatial{48, 36, 20, 29, 42, 42, 20, 42, 22, 41, 45, 14, 6,
                                    0,  33, 28, 34, 4,  32, 24, 47, 41, 24, 26, 30, 41};
  const BootstrapEstimate estimate = bootstrap(spatial, variance, {50'000, 1, 1.6448536269514722});
  EXPECT_NEAR(estimate.value, 171.5, 0.05);
  EXPECT_NEAR(estimate.interval.minimum, 115.8, 2.5);
  EXPECT_NEAR(estimate.interval.maximum, 259.6, 5);
}

/// For many values that are nearly normal it is the textbook's interval.
TEST(Bootstrap, ApproachesTheNormalInterval) {
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(std::sin(i) + std::sin(1.7 * i) + 0.3);
  const BootstrapEstimate estimate = bootstrap(values);
  const double error = std::sqrt(variance(values) / 400);
  EXPECT_NEAR(estimate.interval.minimum, estimate.value - z_95 * error, 0.1 * error);
  EXPECT_NEAR(estimate.interval.maximum, estimate.value + z_95 * error, 0.1 * error);
}

TEST(Bootstrap, RepeatsItself) {
  const std::vector<double> values{0.1, -0.4, 0.9, 1.3, -2.2, 0.7};
  const BootstrapEstimate one = bootstrap(values), other = bootstrap(values);
  EXPECT_EQ(one.interval.minimum, other.interval.minimum);
  EXPECT_EQ(one.interval.maximum, other.interval.maximum);
  EXPECT_LT(one.interval.minimum, one.value);
  EXPECT_GT(one.interval.maximum, one.value);
}

TEST(Bootstrap, SaysNothingOfWhatItCannotKnow) {
  EXPECT_TRUE(std::isnan(bootstrap({}).value));
  const std::vector<double> one{3};
  EXPECT_EQ(bootstrap(one).value, 3);
  EXPECT_TRUE(std::isinf(bootstrap(one).interval.minimum));
  const std::vector<double> same(10, 0.0);
  EXPECT_EQ(bootstrap(same).interval.minimum, 0);
  EXPECT_EQ(bootstrap(same).interval.maximum, 0);
}

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
    double at, share, minimum, maximum;
  } rows[] = {{6, 0.857, 0.620, 0.952},  {7, 0.807, 0.563, 0.923},  {10, 0.753, 0.503, 0.889},
              {13, 0.690, 0.432, 0.849}, {16, 0.627, 0.368, 0.805}, {22, 0.538, 0.268, 0.747},
              {23, 0.448, 0.188, 0.680}};
  const SurvivalCurve curve = kaplan_meier(mercaptopurine);
  ASSERT_EQ(curve.steps.size(), 8u);
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    const SurvivalStep& step = curve.steps[i + 1];
    EXPECT_EQ(step.at, rows[i].at);
    EXPECT_NEAR(step.share, rows[i].share, 5e-4);
    EXPECT_NEAR(step.interval.minimum, rows[i].minimum, 5e-4);
    EXPECT_NEAR(step.interval.maximum, rows[i].maximum, 5e-4);
  }
  EXPECT_EQ(curve.last_at, 35);
}

// Kleinbaum & Klein, Survival Analysis, chapter 2: median remission 23 weeks and 8 weeks.
TEST(KaplanMeier, PublishedMedians) {
  EXPECT_EQ(median_survival(kaplan_meier(mercaptopurine)), 23);
  EXPECT_EQ(median_survival(kaplan_meier(placebo())), 8);
}

/// Without censoring the curve is the plain share.
TEST(KaplanMeier, WithoutCensoringItIsAShare) {
  for (const SurvivalStep& step : kaplan_meier(placebo()).steps) {
    int beyond = 0;
    for (const Lifetime& lifetime : placebo()) beyond += lifetime.at > step.at ? 1 : 0;
    EXPECT_NEAR(step.share, beyond / 21.0, 1e-12);
  }
}

TEST(KaplanMeier, TheEndsOfWhatCanBeSaid) {
  const SurvivalCurve nobody = kaplan_meier({});
  EXPECT_EQ(nobody.steps.size(), 1u);
  EXPECT_EQ(nobody.steps[0].interval.minimum, 0);

  const SurvivalCurve all_well = kaplan_meier({{75, false}, {75, false}});
  EXPECT_EQ(all_well.steps.back().share, 1);
  EXPECT_NEAR(all_well.steps.back().interval.minimum, 0.3424, 5e-5);  // Wilson, 2 of 2
  EXPECT_FALSE(median_survival(all_well));

  const SurvivalCurve all_gone = kaplan_meier({{10, true}, {20, true}});
  ASSERT_EQ(all_gone.steps.size(), 3u);
  EXPECT_EQ(all_gone.steps[1].share, 0.5);
  EXPECT_EQ(all_gone.steps[2].share, 0);
  EXPECT_EQ(all_gone.steps[2].interval.minimum, 0);
  EXPECT_EQ(all_gone.steps[2].interval.maximum, all_gone.steps[1].interval.maximum);
  EXPECT_EQ(median_survival(all_gone), 10);
}

/// By hand: a first value of 1 multiplies a bet of the share s by 1 + s against a mean of 0.
TEST(Sequential, TheEvidenceIsTheMeanOfTheBets) {
  EXPECT_NEAR(std::exp(log_evidence_above({1, 0, 0}, 0)), 1.525, 1e-12);
  EXPECT_NEAR(std::exp(log_evidence_above({0, 0, 1}, 0)), 0.475, 1e-12);
  EXPECT_NEAR(std::exp(log_evidence_above({0, 1, 0}, 0)), 1, 1e-12);
  double sum = 0;  // two gains, one loss and one tie against a mean of -0.1, bet by bet
  for (int k = 1; k <= 20; ++k) {
    const double stake = k / 20.0 / 0.9;
    sum += std::pow(1 + stake * 1.1, 2) * (1 + stake * 0.1) * (1 - stake * 0.9) / 20;
  }
  EXPECT_NEAR(log_evidence_above({2, 1, 1}, -0.1), std::log(sum), 1e-12);
}

/// The rule of three (Hanley & Lippman-Hand 1983, J. Am. Med. Assoc. 249, 1743): none of n, at most 3 / n.
TEST(Sequential, NoneSeenFollowsTheRuleOfThree) {
  EXPECT_NEAR(none_seen_upper_end(100, 0.05), 0.0295, 5e-5);
  EXPECT_NEAR(none_seen_upper_end(1000, 0.05), 3.0 / 1000, 1e-5);
  EXPECT_EQ(none_seen_upper_end(0, 0.05), 1);
}

/// Somebody who looks after every pair sees the true mean left outside at most once in twenty, and the end
/// closes in on it.
TEST(Sequential, TheLowerEndHoldsAtEveryLook) {
  std::mt19937_64 generator(20261127);
  for (const auto& [up, down] : {std::pair(0.02, 0.02), {0.0, 0.05}, {0.3, 0.1}, {0.45, 0.5}}) {
    int left_out = 0;
    double last = 0;
    constexpr int runs = 1000;
    for (int run = 0; run < runs; ++run) {
      SignCounts counts;
      bool was_outside = false;
      for (int i = 0; i < 600; ++i) {
        const double drawn = static_cast<double>(generator() >> 11) * 0x1p-53;
        (drawn < up ? counts.up : drawn < up + down ? counts.down : counts.even) += 1;
        was_outside = was_outside || log_evidence_above(counts, up - down) >= std::log(20);
      }
      left_out += was_outside ? 1 : 0;
      if (run < 20) last += sequential_lower_end(counts, 0.05) / 20;
    }
    EXPECT_LE(left_out, runs * 0.05 + 3 * std::sqrt(runs * 0.05 * 0.95)) << up << " " << down;
    EXPECT_LT(last, up - down);
    EXPECT_GT(last, up - down - 0.16);
  }
}

}  // namespace
}  // namespace understory
