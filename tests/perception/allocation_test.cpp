// A frame allocates nothing once the detector has seen its like. A program of its own: it replaces operator
// new.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "perception/pushbroom_stereo.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace {
long allocation_count = 0;
}

void* operator new(std::size_t size) {
  ++allocation_count;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace understory {
namespace {

TEST(Allocation, AFrameAllocatesNothingAfterTheFirst) {
  const StereoRig rig = support::house_rig("long.yaml");
  StereoFrame frames[3];
  for (std::uint64_t i = 0; i < 3; ++i)
    frames[i] =
        support::render_plane(rig, {.depth_m = PushbroomStereo(rig, {}).detection_depth_m(), .seed = i + 1});
  PushbroomConfig dense = paper_rule(), several = robust_rule();
  dense.every_pixel = true;
  several.depths_m = {10.1, 8.0, 6.0, 5.0};
  for (const PushbroomConfig& config : {paper_rule(), robust_rule(), dense, several}) {
    PushbroomStereo detector(rig, config);
    std::size_t hits = 0;
    for (const StereoFrame& frame : frames) hits += detector.detect(frame).size();
    EXPECT_GT(hits, 300u);
    const long before = allocation_count;
    for (const StereoFrame& frame : frames) detector.detect(frame);
    EXPECT_EQ(allocation_count - before, 0);
  }
}

}  // namespace
}  // namespace understory
