#pragma once

#include <vector>

#include "scenarios/evaluation/detection_grid.hpp"
#include "scenarios/evaluation/share.hpp"

namespace understory {

/// Adds one frame's hits to precision and recall at one pixel. `expected`: expected_blocks of the frame.
void count_one_pixel(const TrueImages& truth, const DetectionGrid& grid,
                     const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits,
                     Share& precision, Share& recall);

}  // namespace understory
