#include "scenarios/evaluation/detection_grid.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

template <typename IntervalOf>
std::vector<ExpectedBlock> blocks_between(const TrueImages& truth, const DetectionGrid& grid,
                                          IntervalOf&& interval_of) {
  std::vector<ExpectedBlock> blocks;
  for (std::size_t depth = 0; depth < grid.depths.size(); ++depth) {
    const DepthInterval interval = interval_of(grid.depths[depth]);
    for (int row = 0; row < grid.rows; ++row)
      for (int column = grid.first_column(depth); column < grid.columns; ++column) {
        const BlockContent content =
            shared_between(truth, column * truth_block_px, row * truth_block_px, interval);
        if (content.holds())
          blocks.push_back({row * grid.columns + column, depth, content.object, content.mean_depth_m});
      }
  }
  return blocks;
}

}  // namespace

LookedAtDepth looked_at_depth(const StereoRig& rig, double asked_m) {
  const int px = static_cast<int>(std::lround(rig.disparity_px(asked_m)));
  return {px,
          rig.depth_m(px),
          {rig.depth_m(px + 1), rig.depth_m(px - 1)},
          {rig.depth_m(px + 0.5), rig.depth_m(px - 0.5)}};
}

DetectionGrid::DetectionGrid(const StereoRig& rig, std::vector<double> depths_m, int last_row_px)
    : columns(rig.width_px / truth_block_px),
      rows(std::min(rig.height_px / truth_block_px, last_row_px / truth_block_px + 1)) {
  if (depths_m.empty()) depths_m.push_back(rig.detection_depth_m);
  for (const double asked_m : depths_m) depths.push_back(looked_at_depth(rig, asked_m));
}

int DetectionGrid::first_column(std::size_t depth) const {
  const int disparity_px = std::max(0, depths[depth].disparity_px);
  return (disparity_px + truth_block_px - 1) / truth_block_px;
}

int DetectionGrid::block_of(const StereoHit& hit) const {
  constexpr int half_px = truth_block_px / 2;
  const int column = (hit.column_px + half_px) / truth_block_px,
            row = (hit.row_px + half_px) / truth_block_px;
  return column < columns && row < rows ? row * columns + column : -1;
}

std::size_t DetectionGrid::depth_of(const StereoHit& hit) const {
  const auto nearest = std::ranges::min_element(depths, {}, [&](const LookedAtDepth& depth) {
    return std::abs(depth.disparity_px - hit.disparity_px);
  });
  return static_cast<std::size_t>(nearest - depths.begin());
}

std::vector<bool> DetectionGrid::places_hit(const std::vector<StereoHit>& hits) const {
  std::vector<bool> hit_at(place(depths.size(), 0));
  for (const StereoHit& hit : hits) {
    const int block = block_of(hit);
    if (block >= 0) hit_at[place(depth_of(hit), block)] = true;
  }
  return hit_at;
}

std::vector<ExpectedBlock> expected_blocks(const TrueImages& truth, const DetectionGrid& grid) {
  return blocks_between(truth, grid, [](const LookedAtDepth& depth) { return depth.one_pixel; });
}

std::vector<ExpectedBlock> expected_blocks(const TrueImages& truth, const DetectionGrid& grid,
                                           double tolerance_m) {
  return blocks_between(truth, grid, [&](const LookedAtDepth& depth) {
    return DepthInterval{depth.depth_m - tolerance_m, depth.depth_m + tolerance_m};
  });
}

}  // namespace understory
