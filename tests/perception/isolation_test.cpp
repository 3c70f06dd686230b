#include "perception/pushbroom/isolation.hpp"

#include <gtest/gtest.h>

namespace understory {
namespace {

TEST(Isolation, KeepsExactlyTheHitsWithCompany) {
  std::vector<StereoHit> hits(6);
  const double x[] = {0.0, 0.9, 5.0,
                      1.7, 5.5, 9.0};  // 0.0 has one other within 1 m, 0.9 two, 1.7 one, 5.0 one
  for (std::size_t i = 0; i < 6; ++i) hits[i].position_camera = {x[i], 0, 10};
  const auto kept = [&](int minimum_points) {
    std::vector<StereoHit> some;
    without_isolated(hits, minimum_points, 1.0, some);
    return some;
  };
  ASSERT_EQ(kept(3).size(), 1u);
  EXPECT_DOUBLE_EQ(kept(3)[0].position_camera.x(), 0.9);
  EXPECT_EQ(kept(2).size(), 5u);
  EXPECT_EQ(kept(1).size(), 6u);
  hits.clear();
  EXPECT_TRUE(kept(3).empty());
}

}  // namespace
}  // namespace understory
