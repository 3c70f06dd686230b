#include "scenarios/evaluation/one_pixel_counts.hpp"

namespace understory {

void count_one_pixel(const TrueImages& truth, const DetectionGrid& grid,
                     const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits,
                     Share& precision, Share& recall) {
  const auto blocks = static_cast<std::size_t>(grid.block_count());
  std::vector<bool> hit_at(blocks * grid.depths.size());
  for (const StereoHit& hit : hits) {
    const std::size_t depth = grid.depth_of(hit);
    precision.count(
        content_between(truth, hit.column_px, hit.row_px, grid.depths[depth].one_pixel, false).holds());
    const int block = grid.block_of(hit);
    if (block >= 0) hit_at[depth * blocks + static_cast<std::size_t>(block)] = true;
  }
  for (const ExpectedBlock& block : expected)
    recall.count(hit_at[block.depth * blocks + static_cast<std::size_t>(block.block)]);
}

}  // namespace understory
