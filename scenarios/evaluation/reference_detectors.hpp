#pragma once

#include <random>
#include <vector>

#include "scenarios/evaluation/ground_truth.hpp"

namespace understory {

/// A hit on the grid's block at a depth looked at: as a detector would put it.
StereoHit hit_on_block(const StereoRig& rig, const LookedAtDepth& depth, int column_px, int row_px);

/// What a detector that knows the truth would say: a hit on every block of the grid that holds any surface,
/// ground too, within one pixel of a depth looked at.
std::vector<StereoHit> true_depth_hits(const TrueImages& truth, const DetectionGrid& grid,
                                       const StereoRig& rig);

/// "Here" at `count` random blocks of the grid, at the first depth looked at: the paper's measure of how
/// little a score means (Barry & Tedrake 2015, evaluations 2 and 3).
std::vector<StereoHit> random_hits(std::size_t count, const DetectionGrid& grid, const StereoRig& rig,
                                   std::mt19937_64& generator);

}  // namespace understory
