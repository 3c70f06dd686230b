#include <gtest/gtest.h>

#include <cmath>

#include "tests/closed_loop/flown.hpp"

/// The whole loop with cameras that are not ideal.
namespace understory {
namespace {

const std::vector<std::string> short_forest{"forest.length_m=20", "forest.square_metres_per_tree=25"};

TEST(CameraFaultsInFlight, RawCamerasAreRectifiedByTheStackAndShowItTheSameTrees) {
  const Flown ideal = flown("forest", 1000, short_forest);
  const Flown raw = flown("forest", 1000, with(short_forest, {"cameras.raw=true"}));
  EXPECT_EQ(raw.outcome(), "goal");
  // Two interpolations soften the bark's edges, so fewer blocks pass, but most trees are still seen.
  EXPECT_GT(3 * raw.detections(), ideal.detections());
  EXPECT_GT(ideal.detections(), raw.detections());
  EXPECT_EQ(raw.digest(), flown("forest", 1000, with(short_forest, {"cameras.raw=true"})).digest());
}

TEST(CameraFaultsInFlight, DroppedFramesNeverArriveAndTheOthersDo) {
  // 0.9 s on the rail and after it: 108 exposures, of which half are dropped.
  const std::vector<std::string> brief{"forest.length_m=20", "time_limit_s=0.9"};
  const auto frames = [&](const char* probability) {
    return flown("clear", 1000, with(brief, {std::string("cameras.drop_probability=") + probability}))
        .result.at("frames")
        .get<double>();
  };
  const double all = frames("0");
  EXPECT_GT(all, 100);
  EXPECT_NEAR(frames("0.5"), 0.5 * all, 4 * std::sqrt(0.25 * all));
  EXPECT_EQ(frames("1"), 0);
}

TEST(CameraFaultsInFlight, WhatIsOffChangesNothingAndWhatIsOnRepeats) {
  // Settings that only matter together with others that are off.
  const Flown plain = flown("forest", 1000, short_forest);
  EXPECT_EQ(flown("forest", 1000, with(short_forest, {"cameras.exposure_views=9"})).digest(), plain.digest());
  const std::vector<std::string> everything =
      with(short_forest, {"cameras.exposure_s=0.003", "cameras.exposure_views=2",
                          "cameras.right_delay_s=0.001", "cameras.full_well_e=10000", "cameras.light=0.5",
                          "cameras.gain=2", "cameras.vignetting_power=4", "cameras.drop_probability=0.05",
                          "cameras.vertical_misalignment_px=0.3", "cameras.flex_position_m=[0.001,0,0]"});
  const Flown one = flown("forest", 1000, everything), other = flown("forest", 1000, everything);
  EXPECT_EQ(one.digest(), other.digest());
  EXPECT_NE(one.digest(), plain.digest());
  EXPECT_GT(one.detections(), 0);
}

}  // namespace
}  // namespace understory
