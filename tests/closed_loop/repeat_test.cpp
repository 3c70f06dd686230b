#include <dlfcn.h>
#include <gtest/gtest.h>

#include "sim/render/offscreen_backend.hpp"
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

TEST(Repeat, FullStereoOnABusyComputerIsTheSameToTheBit) {
  const auto busy = with(short_forest, {"perception.detector=stereo_bm", "perception.compute.enabled=true"});
  const Flown one = flown("forest", 1000, busy);
  const Flown other = flown("forest", 1000, busy);
  EXPECT_EQ(one.digest(), other.digest());
  EXPECT_EQ(one.trajectory, other.trajectory);
  EXPECT_GT(one.detections(), 0);
  // 8.3 times 9.0 ms each: the flight's length in frames, the one in work at the end apart.
  const double frames = one.result.at("simulated_s").get<double>() / (8.3 * 0.0090);
  EXPECT_NEAR(one.result.at("frames").get<double>(), frames, 1.2);
}

TEST(Repeat, TheOtherLibraryDrawsTheSameFlight) {
  if (void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
    dlclose(library);
  } else {
    GTEST_SKIP() << "no libEGL.so.1 here (Debian's libegl1)";
  }
  if (has_gpu_device_file()) GTEST_SKIP() << "a GPU is here, and EGL draws on it";
  const Flown osmesa = flown("forest", 1000, short_forest, "--renderer osmesa");
  const Flown egl = flown("forest", 1000, short_forest, "--renderer egl");
  EXPECT_EQ(osmesa.digest(), egl.digest());
  EXPECT_NE(std::string(egl.result.at("versions").at("renderer")).find("llvmpipe"), std::string::npos);
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
