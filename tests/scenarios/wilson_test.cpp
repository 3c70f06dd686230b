#include "scenarios/statistics/wilson.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace understory
