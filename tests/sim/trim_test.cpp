#include "sim/aircraft/aerodynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr double degree = std::numbers::pi / 180;

// Flight records of the original aircraft: the identified model's own trim, within 1 %.
TEST(Trim, RecordsTrimIsFound) {
  const std::optional<Trim> trim = straight_trim(Airframe{}, 12.27);
  ASSERT_TRUE(trim);
  EXPECT_NEAR(trim->angle_of_attack_rad, 10.97 * degree, 0.01 * 10.97 * degree);
  EXPECT_NEAR(trim->elevon_rad, 0.1914, 0.01 * 0.1914);
  EXPECT_NEAR(trim->thrust_n, 5.08, 0.01 * 5.08);
}

TEST(Trim, LevelFlightReachesFrom8To12Point8) {
  const std::optional<Trim> slow = straight_trim(Airframe{}, 8.0);
  ASSERT_TRUE(slow);
  EXPECT_NEAR(slow->angle_of_attack_rad, 25 * degree, 1 * degree);
  EXPECT_FALSE(straight_trim(Airframe{}, 7.0));
  const std::optional<Trim> fast = straight_trim(Airframe{}, 12.7);
  ASSERT_TRUE(fast);
  EXPECT_NEAR(fast->thrust_n, 5.34, 0.1);
  EXPECT_FALSE(straight_trim(Airframe{}, 12.9));
}

TEST(Trim, FasterThanThatOnlyDescending) {
  EXPECT_TRUE(straight_trim(Airframe{}, 14.0, -0.25));
  EXPECT_FALSE(straight_trim(Airframe{}, 14.0, 0.0));
}

TEST(Trim, AttackCapIsRespected) { EXPECT_FALSE(straight_trim(Airframe{}, 9.0, 0, 10 * degree)); }

}  // namespace
}  // namespace understory
