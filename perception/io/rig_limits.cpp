#include "perception/io/rig_limits.hpp"

#include <algorithm>
#include <cmath>

namespace understory::rig_limits {

bool detection_depth_in_view(const StereoRig& rig) {
  constexpr int block_px = 5;
  const double disparity_px = std::round(rig.disparity_px(rig.detection_depth_m));
  return disparity_px - rig.infinity_disparity_px() > 1.0 &&
         std::abs(disparity_px) <= std::min(0.9 * rig.width_px, 1.0 * rig.width_px - block_px);
}

}  // namespace understory::rig_limits
