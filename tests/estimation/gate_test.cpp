#include "estimation/gate.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace understory {
namespace {

TEST(Gate, QuantilesAgreeWithTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841, 1e-3);
  EXPECT_NEAR(chi_square_quantile(0.999, 1), 10.828, 1e-3);
  EXPECT_NEAR(chi_square_quantile(0.95, 2), 5.991, 1e-3);
  EXPECT_NEAR(chi_square_quantile(0.99, 3), 11.345, 1e-3);
}

TEST(Gate, RefusesOutliersButNotForEver) {
  Gate gate(10, 0.1, Distrust::believe);
  EXPECT_TRUE(gate.admits(9, 0));
  EXPECT_FALSE(gate.admits(11, 20'000'000));
  EXPECT_TRUE(gate.admits(1, 40'000'000));  // it agrees again: patience starts anew
  EXPECT_FALSE(gate.admits(11, 60'000'000));
  EXPECT_FALSE(gate.admits(11, 160'000'000));
  EXPECT_TRUE(gate.admits(11, 170'000'000));
  EXPECT_FALSE(gate.admits(std::numeric_limits<double>::quiet_NaN(), 180'000'000));
}

TEST(Gate, AFaultySensorStaysOutUntilItHasAgreedAsLong) {
  Gate gate(10, 0.1, Distrust::exclude);
  const auto at = [&](double squared, std::int64_t t_ms) { return gate.admits(squared, t_ms * 1'000'000); };
  EXPECT_TRUE(at(1, 0));
  EXPECT_FALSE(at(50, 20));
  EXPECT_FALSE(gate.faulty());  // a single outlier is no fault
  EXPECT_FALSE(at(50, 130));
  EXPECT_TRUE(gate.faulty());
  EXPECT_FALSE(at(1, 140));  // one agreement does not end a fault
  EXPECT_FALSE(at(50, 200));
  EXPECT_FALSE(at(1, 220));
  EXPECT_FALSE(at(1, 320));
  EXPECT_TRUE(at(1, 330));
  EXPECT_FALSE(gate.faulty());
  EXPECT_EQ(gate.newest(), 1);
}

}  // namespace
}  // namespace understory
