#include "perception/block_matching.hpp"

#include <gtest/gtest.h>

#include "tests/perception/rigs.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace understory {
namespace {

TEST(BlockMatching, SeesAPlaneInsideItsCropAndNoneOutside) {
  for (const char* name : {"paper.yaml", "long.yaml"}) {
    const StereoRig rig = support::house_rig(name);
    BlockMatching matching(rig, {});
    const double away_m = rig.detection_depth_m > 8 ? 2.0 : 1.0;
    // Half a pixel of disparity is about what StereoBM's own noise needs.
    for (const double depth_m : {rig.detection_depth_m, rig.detection_depth_m + 0.1}) {
      const auto hits = matching.detect(support::render_plane(rig, {.depth_m = depth_m, .grain_px = 3}));
      ASSERT_GT(hits.size(), 1000u) << name;
      double mean_m = 0;
      for (const StereoHit& hit : hits) mean_m += hit.position_camera.z() / static_cast<double>(hits.size());
      EXPECT_NEAR(mean_m, depth_m, 0.1) << name;
    }
    for (const double sign : {-1.0, 1.0}) {
      const double depth_m = rig.detection_depth_m + sign * away_m;
      EXPECT_LT(matching.detect(support::render_plane(rig, {.depth_m = depth_m, .grain_px = 3})).size(), 20u)
          << name;
    }
  }
}

}  // namespace
}  // namespace understory
