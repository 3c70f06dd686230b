#include "scenarios/evaluation/random_detector.hpp"

#include <algorithm>

namespace understory {

StereoHit hit_on_block(const StereoRig& rig, const LookedAtDepth& depth, int column_px, int row_px) {
  constexpr double center_px = 0.5 * (truth_block_px - 1);
  StereoHit hit;
  hit.column_px = column_px;
  hit.row_px = row_px;
  hit.disparity_px = depth.disparity_px;
  hit.depth = depth.one_pixel;
  hit.position_camera = {(column_px + center_px - rig.center_left_x_px) * depth.depth_m / rig.focal_px,
                         (row_px + center_px - rig.center_y_px) * depth.depth_m / rig.focal_px,
                         depth.depth_m};
  return hit;
}

RandomDetector::RandomDetector(const StereoRig& rig, const DetectionGrid& grid, std::uint64_t seed)
    : rig_(rig), grid_(grid), generator_(seed) {}

const std::vector<StereoHit>& RandomDetector::detect(const StereoFrame&) {
  hits_.clear();
  const int first = grid_.first_column(0), columns = grid_.columns - first;
  if (columns <= 0) return hits_;
  for (std::size_t i = 0; i < count_; ++i) {
    // Remainders favour small numbers by one part in 2^51; distributions of the library differ by platform.
    const int place = static_cast<int>(generator_() % static_cast<std::uint64_t>(columns * grid_.rows));
    hits_.push_back(hit_on_block(rig_, grid_.depths[0], (first + place % columns) * truth_block_px,
                                 place / columns * truth_block_px));
  }
  std::ranges::sort(hits_, [](const StereoHit& a, const StereoHit& b) {
    return a.row_px != b.row_px ? a.row_px < b.row_px : a.column_px < b.column_px;
  });
  return hits_;
}

}  // namespace understory
