#include "scenarios/statistics/paired_outcomes.hpp"

#include <gtest/gtest.h>

namespace understory {
namespace {

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

}  // namespace
}  // namespace understory
