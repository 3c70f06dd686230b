#pragma once

#include <vector>

#include "perception/stereo_rig.hpp"
#include "scenarios/evaluation/detection_grid.hpp"

namespace understory {

/// What a detector that knows the truth would say: a hit on every block of the grid that holds any surface,
/// ground too, within one pixel of a depth looked at.
std::vector<StereoHit> true_depth_hits(const TrueImages& truth, const DetectionGrid& grid,
                                       const StereoRig& rig);

}  // namespace understory
