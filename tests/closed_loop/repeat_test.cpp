#include <gtest/gtest.h>

#include "tests/closed_loop/flown.hpp"

namespace understory {
namespace {

const std::vector<std::string> short_forest{"forest.length_m=20", "forest.square_metres_per_tree=25"};

TEST(Repeat, TheSameFlightTwiceIsTheSameToTheBit) {
  const Flown one = flown("forest", 1000, short_forest);
  const Flown other = flown("forest", 1000, short_forest);
  EXPECT_EQ(one.digest(), other.digest());  // every image, pose, estimate and control
  EXPECT_EQ(one.trajectory, other.trajectory);
  EXPECT_GT(one.result.at("frames"), 100);
  EXPECT_GT(one.detections(), 0);
}

TEST(Repeat, AnotherSensorSeedIsAnotherFlightThroughTheSameForest) {
  const Flown one = flown("forest", 1000, with(short_forest, {"sensors.seed=1"}));
  const Flown other = flown("forest", 1000, with(short_forest, {"sensors.seed=2"}));
  EXPECT_NE(one.digest(), other.digest());
  EXPECT_NE(one.trajectory, other.trajectory);
  // On the rail nothing has been decided yet, and the forest is the same: so is the first distance to it.
  EXPECT_EQ(columns(one, {"x_m", "z_m", "clearance_m"}).front(),
            columns(other, {"x_m", "z_m", "clearance_m"}).front());
}

TEST(Repeat, AnotherSeedIsAnotherForest) {
  const Flown one = flown("forest", 1000, with(short_forest, {"cameras.rate_hz=1"}));
  const Flown other = flown("forest", 1001, with(short_forest, {"cameras.rate_hz=1"}));
  EXPECT_NE(columns(one, {"clearance_m"}).front(), columns(other, {"clearance_m"}).front());
}

}  // namespace
}  // namespace understory
