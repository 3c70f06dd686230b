#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/pushbroom/pushbroom_kernel.hpp"
#include "perception/rectify.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// Every number and every rule of the detector. Defaults are the paper's rule as the original's public code
/// had it (Barry & Tedrake 2015); each rule is a switch of its own.
struct PushbroomConfig {
  std::vector<double> depths_m;  ///< to look at; empty: the rig's own detection depth. 0.1 .. 1000
  /// For each of depths_m its own threshold, in their order; empty: the ones below for all. Same ranges as
  /// there.
  std::vector<double> depths_minimum_edge_sum, depths_score_limit;
  int threads = 1;           ///< 1 .. 64; hits do not depend on it
  int stride_px = 5;         ///< from block to block, both ways; 1 .. 100; 5 sets the 5x5 blocks side by side
  bool every_pixel = false;  ///< dense: a window at every pixel, of each 5x5 cell of windows the best counts
  int last_row_px = 205;     ///< top edge of the lowest row of blocks; rows below see the ground
  int minimum_edge_sum = 860;         ///< Laplacian sum asked of each image's block by itself; 0 .. 6375
  double score_limit = 54.0 / 333.0;  ///< hit if S = SAD / (both edge sums) is below; exact to 1/333000

  bool horizontal_invariance = true;  ///< reject texture that also matches near infinity
  int invariance_columns_px = 3;      ///< searched to each side of infinity
  int invariance_rows_px = 8;         ///< searched up and down
  int invariance_row_step_px = 2;
  double invariance_score_limit = 108.0 / 333.0;  ///< twice the score limit: 0.324

  bool uniqueness = false;        ///< the disparity must stand out along the row
  double uniqueness_ratio = 2.0;  ///< no other disparity within this many times its SAD
  double uniqueness_minimum_depth_m =
      1.5;  ///< range searched: infinity to here (the paper ignores nearer points)

  /// Puts a hit at the vertex of the parabola through the SADs of its disparity and the two beside it, at
  /// most half a pixel away, where its own is the minimum of the three.
  bool subpixel = false;

  bool isolation = false;            ///< a hit needs company in its own frame
  int isolation_minimum_points = 3;  ///< itself included (the original's avoidance)
  double isolation_radius_m = 1.0;
};

/// The last row of blocks, 205 of the paper's 240 rows, in an image of this height.
int last_row_px_of(int height_px);

/// The paper's rule, exactly.
PushbroomConfig paper_rule();
/// Uniqueness instead of the invariance filter, gentler thresholds, 3 points within 1 m: on rendered forests
/// its precision is 0.94 where the paper's thresholds give 0.37 (computed with one prototype;
/// docs/benchmarks.md).
PushbroomConfig robust_rule();
/// The robust rule with the numbers tuned for a rig of models/rigs by its name, `long` or `paper`: most
/// recall at a precision of 0.985 (docs/tuning.md). Rigs that nobody has tuned for get robust_rule().
PushbroomConfig tuned_rule(std::string_view rig);

template <typename Visitor>
void visit_fields(Visitor& visit, PushbroomConfig& config) {
  visit("threads", config.threads, 1, 64);
  visit("stride_px", config.stride_px, 1, 100);
  visit("every_pixel", config.every_pixel);
  visit("last_row_px", config.last_row_px, 0, 4000);
  visit("minimum_edge_sum", config.minimum_edge_sum, 0, 6375);
  visit("score_limit", config.score_limit, 0.0, 10.0);
  visit("horizontal_invariance", config.horizontal_invariance);
  visit("invariance_columns_px", config.invariance_columns_px, 0, 50);
  visit("invariance_rows_px", config.invariance_rows_px, 0, 50);
  visit("invariance_row_step_px", config.invariance_row_step_px, 1, 50);
  visit("invariance_score_limit", config.invariance_score_limit, 0.0, 10.0);
  visit("uniqueness", config.uniqueness);
  visit("uniqueness_ratio", config.uniqueness_ratio, 1.0, 100.0);
  visit("uniqueness_minimum_depth_m", config.uniqueness_minimum_depth_m, 0.1, 100.0);
  visit("depths_minimum_edge_sum", config.depths_minimum_edge_sum, 0, 6375);
  visit("depths_score_limit", config.depths_score_limit, 0.0, 10.0);
  visit("subpixel", config.subpixel);
  visit("isolation", config.isolation);
  visit("isolation_minimum_points", config.isolation_minimum_points, 1, 1000);
  visit("isolation_radius_m", config.isolation_radius_m, 0.0, 100.0);
}

/// Pushbroom stereo (Barry & Tedrake 2015): looks at one disparity only (or a few), and lets the aircraft's
/// motion sweep that surface through the world. Exact: the same hits on every instruction set and with any
/// number of threads. Detection disparities and infinity come from the rig.
class PushbroomStereo : public ObstacleDetector {
 public:
  /// Asserts that each detection depth gives a disparity beyond infinity and inside the image, and that there
  /// are as many thresholds as depths, or none.
  PushbroomStereo(const StereoRig& rig, const PushbroomConfig& config);
  /// For raw pairs: each is rectified to the nearest pixel on the way, as far as the rule looks, which equals
  /// Rectifier and then detection. detection_depth_m serves where the config names no depths. Images must be
  /// at least ByteRemap::chunk_px wide.
  PushbroomStereo(const StereoCalibration& calibration, double detection_depth_m,
                  const PushbroomConfig& config);

  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

  int depth_count() const { return static_cast<int>(depths_.size()); }
  /// Depth of the whole disparity used: where hits are put. Near, not equal to, the depth asked for.
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

  StereoRig rig_;
  PushbroomConfig config_;
  int infinity_px_;
  std::vector<Depth> depths_;
  std::optional<Maps> maps_;  ///< where pairs come raw
  std::vector<Band> bands_;   ///< one for each thread
  std::vector<StereoHit> all_hits_, hits_;
};

}  // namespace understory
