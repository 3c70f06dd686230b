#include "scenarios/evaluation/reference_detectors.hpp"

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

std::vector<StereoHit> true_depth_hits(const TrueImages& truth, const DetectionGrid& grid,
                                       const StereoRig& rig) {
  std::vector<StereoHit> hits;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      for (std::size_t depth = 0; depth < grid.depths.size(); ++depth) {
        if (column < grid.first_column(depth)) continue;
        const int column_px = column * truth_block_px, row_px = row * truth_block_px;
        if (content_between(truth, column_px, row_px, grid.depths[depth].one_pixel, Surfaces::any).holds())
          hits.push_back(hit_on_block(rig, grid.depths[depth], column_px, row_px));
      }
  return hits;
}

std::vector<StereoHit> random_hits(std::size_t count, const DetectionGrid& grid, const StereoRig& rig,
                                   std::mt19937_64& generator) {
  std::vector<StereoHit> hits;
  const int first = grid.first_column(0), columns = grid.columns - first;
  if (columns <= 0) return hits;
  for (std::size_t i = 0; i < count; ++i) {
    // Remainders favour small numbers by one part in 2^51; distributions of the library differ by platform.
    const int place = static_cast<int>(generator() % static_cast<std::uint64_t>(columns * grid.rows));
    hits.push_back(hit_on_block(rig, grid.depths[0], (first + place % columns) * truth_block_px,
                                place / columns * truth_block_px));
  }
  std::ranges::sort(hits, [](const StereoHit& a, const StereoHit& b) {
    return a.row_px != b.row_px ? a.row_px < b.row_px : a.column_px < b.column_px;
  });
  return hits;
}

}  // namespace understory
