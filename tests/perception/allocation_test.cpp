// A frame allocates nothing once the detector has seen its like.
#include <gtest/gtest.h>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/counted_allocations.hpp"
#include "tests/support/synthetic_stereo.hpp"

namespace understory {
namespace {

/// Raw cameras that happen to see what rectified ones would, so that pairs of the rig serve as raw ones.
StereoCalibration calibration_of(const StereoRig& rig) {
  StereoCalibration calibration{rig.name, rig.width_px, rig.height_px, {}, {}, rig.T_body_camera};
  const double f = rig.focal_px, v = rig.center_y_px;
  for (const bool is_left : {true, false}) {
    const double u = is_left ? rig.center_left_x_px : rig.center_right_x_px;
    CameraCalibration& camera = is_left ? calibration.left : calibration.right;
    camera.camera_matrix = {f, 0, u, 0, f, v, 0, 0, 1};
    camera.distortion = {0, 0, 0, 0};
    camera.rectification = cv::Matx33d::eye();
    camera.projection = support::projection_of(f, u, v, is_left ? 0 : rig.baseline_m);
  }
  return calibration;
}

void expect_no_allocation(PushbroomStereo& detector, const StereoFrame (&frames)[3]) {
  std::size_t hits = 0;
  for (const StereoFrame& frame : frames) hits += detector.detect(frame).size();
  EXPECT_GT(hits, 300u);
  const long before = support::allocation_count;
  for (const StereoFrame& frame : frames) detector.detect(frame);
  EXPECT_EQ(support::allocation_count - before, 0);
}

TEST(Allocation, AFrameAllocatesNothingAfterTheFirst) {
  const StereoRig rig = support::house_rig("long.yaml");
  StereoFrame frames[3];
  for (std::uint64_t i = 0; i < 3; ++i)
    frames[i] =
        support::render_plane(rig, {.depth_m = PushbroomStereo(rig, {}).detection_depth_m(), .seed = i + 1});
  PushbroomConfig several = robust_pushbroom();
  several.depths_m = {10.1, 8.0, 6.0, 5.0};
  for (PushbroomConfig config : {original_pushbroom(), robust_pushbroom(), several})
    for (const int threads : {1, 2}) {
      config.threads = threads;
      PushbroomStereo rectified(rig, config);
      PushbroomStereo raw(CalibratedRig{rig, calibration_of(rig)}, config);
      for (PushbroomStereo* detector : {&rectified, &raw}) expect_no_allocation(*detector, frames);
    }
}

}  // namespace
}  // namespace understory
