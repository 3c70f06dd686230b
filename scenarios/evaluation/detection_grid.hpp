#pragma once

#include <vector>

#include "perception/stereo_hit.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/evaluation/block_truth.hpp"

namespace understory {

/// A depth that is looked at: that of the whole disparity nearest to what was asked for.
struct LookedAtDepth {
  int disparity_px = 0;
  double depth_m = 0;
  DepthInterval one_pixel;
  DepthInterval half_pixel;  ///< whose disparities round to this one: what a look at it can match
};

/// As PushbroomStereo looks. Depths whose disparity lies within a pixel of infinity assert there.
LookedAtDepth looked_at_depth(const StereoRig& rig, double asked_m);

/// Where something is to be found: blocks of 5x5 px side by side, down to the last row looked at, and only
/// columns whose partner at the disparity lies in the right image. The same for every algorithm.
struct DetectionGrid {
  DetectionGrid(const StereoRig& rig, std::vector<double> depths_m, int last_row_px);

  std::vector<LookedAtDepth> depths;
  int columns = 0;  ///< of blocks
  int rows = 0;

  int first_column(std::size_t depth) const;
  int block_count() const { return columns * rows; }
  /// Of the block that the hit's centre lies in; -1 where that is none of the grid's.
  int block_of(const StereoHit& hit) const;
  /// The depth looked at that is nearest to the hit's.
  std::size_t depth_of(const StereoHit& hit) const;
  /// A block's place among the blocks of all depths.
  std::size_t place(std::size_t depth, int block) const {
    return depth * static_cast<std::size_t>(block_count()) + static_cast<std::size_t>(block);
  }
  /// Of every place, whether one of the hits lies there.
  std::vector<bool> places_hit(const std::vector<StereoHit>& hits) const;
};

/// A block that holds an obstacle at a depth looked at, where both eyes see it.
struct ExpectedBlock {
  int block = 0;  ///< row * columns + column
  std::size_t depth = 0;
  int object = 0;
  double mean_depth_m = 0;
};

/// All of them in one frame, between `depths` around each depth looked at: the one-pixel interval, or so many
/// metres to either side.
std::vector<ExpectedBlock> expected_blocks(const TrueImages& truth, const DetectionGrid& grid);
std::vector<ExpectedBlock> expected_blocks(const TrueImages& truth, const DetectionGrid& grid,
                                           double tolerance_m);

}  // namespace understory
