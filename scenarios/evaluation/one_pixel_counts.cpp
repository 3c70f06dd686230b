#include "scenarios/evaluation/one_pixel_counts.hpp"

namespace understory {

void count_one_pixel(const TrueImages& truth, const DetectionGrid& grid,
                     const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits,
                     Share& precision, Share& recall) {
  for (const StereoHit& hit : hits)
    precision.count(
        content_between(truth, hit.column_px, hit.row_px, grid.depths[grid.depth_of(hit)].one_pixel, false)
            .holds());
  const std::vector<bool> hit_at = grid.places_hit(hits);
  for (const ExpectedBlock& block : expected) recall.count(hit_at[grid.place(block.depth, block.block)]);
}

}  // namespace understory
