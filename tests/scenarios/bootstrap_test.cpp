#include "scenarios/statistics/bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace understory {
namespace {

double variance(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size());
}

// Efron & Tibshirani 1993, An Introduction to the Bootstrap, tables 2.1 and 2.2: days that the treated mice
// lived; the standard error of their mean, with endless resamples, 23.36.
TEST(Bootstrap, PublishedStandardError) {
  const std::vector<double> treated{94, 197, 16, 38, 99, 141, 23};
  const BootstrapEstimate estimate = bootstrap(treated, mean_of, {200'000, 1});
  EXPECT_NEAR(estimate.value, 86.86, 5e-3);
  EXPECT_NEAR(estimate.standard_error, 23.36, 0.12);
}

// The same, tables 14.1 and 14.2: the spatial test's A values; their variance (171.5) has the 90 % BCa
// interval 115.8 to 259.6, of 2000 resamples, which leaves an upper end uncertain by some 5.
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
  EXPECT_NEAR(estimate.standard_error, error, 0.03 * error);
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

}  // namespace
}  // namespace understory
