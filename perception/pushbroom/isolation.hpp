#pragma once

#include <vector>

#include "perception/stereo_hit.hpp"

namespace understory {

/// Puts into `kept` the hits that have company: at least `minimum_points` of the same frame, itself included,
/// within `radius_m` (camera frame). Order is kept. The original's avoidance counted a point with 3
/// within 1.0 m.
void without_isolated(const std::vector<StereoHit>& hits, int minimum_points, double radius_m,
                      std::vector<StereoHit>& kept);

}  // namespace understory
