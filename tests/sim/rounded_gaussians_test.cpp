#include "sim/cameras/image_sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

TEST(RoundedGaussians, AreTheStandardLibrarysRounded) {
  constexpr std::size_t count = 1 << 17;
  for (const double deviation : {1e-3, 0.3, 1.0, 2.0, 7.5, 60.0, 1e4})
    for (const std::uint64_t seed : {0u, 1u, 1000u}) {
      std::mt19937_64 ours(seed), theirs(seed);
      const std::vector<std::int8_t> rounded = rounded_gaussians(count, deviation, ours);
      std::normal_distribution<double> gaussian(0.0, deviation);
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(rounded[i], std::clamp(std::lround(gaussian(theirs)), -127L, 127L))
            << "number " << i << ", deviation " << deviation << ", seed " << seed;
      EXPECT_EQ(ours, theirs);  // as many draws
    }
}

}  // namespace
}  // namespace understory
