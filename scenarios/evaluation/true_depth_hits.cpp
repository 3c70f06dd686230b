#include "scenarios/evaluation/true_depth_hits.hpp"

#include "scenarios/evaluation/random_detector.hpp"

namespace understory {

std::vector<StereoHit> true_depth_hits(const TrueImages& truth, const DetectionGrid& grid,
                                       const StereoRig& rig) {
  std::vector<StereoHit> hits;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      for (std::size_t depth = 0; depth < grid.depths.size(); ++depth) {
        if (column < grid.first_column(depth)) continue;
        const int column_px = column * truth_block_px, row_px = row * truth_block_px;
        if (content_between(truth, column_px, row_px, grid.depths[depth].one_pixel, false).holds())
          hits.push_back(hit_on_block(rig, grid.depths[depth], column_px, row_px));
      }
  return hits;
}

}  // namespace understory
