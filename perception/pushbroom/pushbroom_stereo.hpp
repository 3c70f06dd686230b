#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/perception_config.hpp"
#include "perception/pushbroom/pushbroom_kernel.hpp"
#include "perception/rectification/rectify.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// The depths that the rule states: depths_m, or those of disparities_px. Empty: the rig's own depth.
std::vector<double> stated_depths_m(const PushbroomConfig& config, const StereoRig& rig);

/// Why the rule cannot be used with this rig, in one line that begins with the key at fault ("threads:
/// expected 1 to 64, found 0"): a number out of its range, a list of thresholds that is neither empty nor as
/// long as the depths, a depth that the images cannot show (StereoRig::can_look_at). Empty if it can.
std::string fault_of(const PushbroomConfig& config, const StereoRig& rig);

/// Puts into `kept` the hits that have at least `minimum_points` hits of the same frame, itself included,
/// within `radius_m` (camera frame). Order is kept. The original's avoidance counted a point with 3 within
/// 1.0 m.
void without_isolated(const std::vector<StereoHit>& hits, int minimum_points, double radius_m,
                      std::vector<StereoHit>& kept);

/// Pushbroom stereo (Barry & Tedrake 2015): looks at one disparity only (or a few), and lets the aircraft's
/// motion sweep that surface through the world. Exact: the same hits on every instruction set and with any
/// number of threads. Detection disparities and infinity come from the rig.
class PushbroomStereo : public ObstacleDetector {
 public:
  /// Throws std::invalid_argument with fault_of's line if there is one.
  PushbroomStereo(const StereoRig& rig, const PushbroomConfig& config);
  /// Takes pairs as they come from the rig. Raw ones are rectified to the nearest pixel, only in the part
  /// that the rule uses; hits equal those of Rectifier and then detection. Raw images must be at least
  /// ByteRemap::chunk_px wide.
  PushbroomStereo(const CalibratedRig& rig, const PushbroomConfig& config);

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

  int depth_count() const { return static_cast<int>(depths_.size()); }
  /// Depth of the whole disparity used, which hits get. Near, not equal to, the requested depth.
  double detection_depth_m(int depth = 0) const { return depths_[static_cast<std::size_t>(depth)].depth_m; }
  DepthInterval one_pixel_interval(int depth = 0) const {
    return depths_[static_cast<std::size_t>(depth)].interval;
  }
  int detection_disparity_px(int depth = 0) const {
    return depths_[static_cast<std::size_t>(depth)].disparity_px;
  }
  int infinity_disparity_px() const { return infinity_px_; }  ///< rounded, as the whole-pixel searches use it

 private:
  struct Depth {
    int disparity_px = 0;
    double depth_m = 0;
    DepthInterval interval;
  };
  /// Part of the strips, one thread's work.
  struct Band {
    PushbroomKernel kernel;
    std::vector<std::uint8_t> left, right;  ///< rectified images, the band's rows
    const std::vector<BlockMatch>* matches = nullptr;
  };
  struct Maps {
    ByteRemap left, right;
  };
  BlockRule block_rule() const;
  void search(const GrayView& left, const GrayView& right, int index);
  StereoHit hit_of(const BlockMatch& match) const;
  void keep_best_of_cells();

  StereoRig rig_;
  PushbroomConfig config_;
  int infinity_px_;
  std::vector<Depth> depths_;
  std::optional<Maps> maps_;  ///< where pairs come raw
  std::vector<Band> bands_;   ///< one for each thread
  std::vector<StereoHit> all_hits_, hits_;
  std::vector<std::size_t> best_of_cells_;  ///< indices of hits_
};

}  // namespace understory
