#include "scenarios/evaluation/ground_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace understory {
namespace {

/// The commonest of the numbers, the smaller where two are as common.
int commonest(std::array<int, truth_block_px * truth_block_px>& numbers, int count) {
  const auto end = numbers.begin() + count;
  std::sort(numbers.begin(), end);
  int best = 0;
  std::ptrdiff_t most = 0;
  for (auto from = numbers.begin(); from != end;) {
    const auto to = std::upper_bound(from, end, *from);
    if (to - from > most) {
      most = to - from;
      best = *from;
    }
    from = to;
  }
  return best;
}

}  // namespace

cv::Mat shared_depth(const cv::Mat& depth_mm, const StereoRig& rig) {
  constexpr double nearer = 0.9;  // of the depth: another surface, not the same one's slope
  cv::Mat shared = depth_mm.clone();
  std::vector<int> right_mm(static_cast<std::size_t>(depth_mm.cols));
  std::vector<int> place(static_cast<std::size_t>(depth_mm.cols));
  for (int v = 0; v < depth_mm.rows; ++v) {
    const auto* depth = depth_mm.ptr<std::uint16_t>(v);
    auto* kept = shared.ptr<std::uint16_t>(v);
    std::ranges::fill(right_mm, 0);
    for (int u = 0; u < depth_mm.cols; ++u) {
      const auto column = static_cast<std::size_t>(u);
      place[column] = -1;
      if (depth[u] == 0) continue;
      const long right_px = std::lround(u - rig.disparity_px(1e-3 * depth[u]));
      if (right_px < 0 || right_px >= depth_mm.cols) continue;
      place[column] = static_cast<int>(right_px);
      int& there_mm = right_mm[static_cast<std::size_t>(right_px)];
      if (there_mm == 0 || depth[u] < there_mm) there_mm = depth[u];
    }
    for (int u = 0; u < depth_mm.cols; ++u) {
      const int right_px = place[static_cast<std::size_t>(u)];
      if (right_px < 0 || right_mm[static_cast<std::size_t>(right_px)] < nearer * depth[u]) kept[u] = 0;
    }
  }
  return shared;
}

BlockContent content_between(const TrueImages& truth, int column_px, int row_px, DepthInterval depths,
                             Surfaces surfaces) {
  // A truncation is cheaper than a call of lround, for every block of every frame.
  const auto near_mm = static_cast<int>(std::clamp(1000 * depths.near_m, 1.0, 65535.0) + 0.5);
  const auto far_mm = static_cast<int>(std::clamp(1000 * depths.far_m, 0.0, 65535.0) + 0.5);
  const bool has_objects = !truth.objects.empty();
  const cv::Mat& depth_image =
      surfaces == Surfaces::shared_obstacles ? truth.shared_depth_mm : truth.depth_mm;
  BlockContent content;
  std::array<int, truth_block_px * truth_block_px> objects;
  std::int64_t sum_mm = 0;
  for (int v = row_px; v < row_px + truth_block_px; ++v) {
    const auto* depth_mm = depth_image.ptr<std::uint16_t>(v);
    const auto* object = has_objects ? truth.objects.ptr<std::uint16_t>(v) : nullptr;
    for (int u = column_px; u < column_px + truth_block_px; ++u) {
      if (depth_mm[u] < near_mm || depth_mm[u] > far_mm) continue;
      if (surfaces != Surfaces::any && object != nullptr && !truth.is_obstacle(object[u])) continue;
      objects[static_cast<std::size_t>(content.pixels++)] = object != nullptr ? object[u] : 0;
      sum_mm += depth_mm[u];
    }
  }
  if (content.pixels == 0) return content;
  content.object = commonest(objects, content.pixels);
  content.mean_depth_m = 1e-3 * static_cast<double>(sum_mm) / content.pixels;
  return content;
}

DetectionDepth detection_depth(const StereoRig& rig, double asked_m) {
  const int px = static_cast<int>(std::lround(rig.disparity_px(asked_m)));
  return {px, rig.depth_m(px), rig.depths_around(px), rig.depths_around(px, 0.5)};
}

DetectionGrid::DetectionGrid(const StereoRig& rig, std::vector<double> depths_m, int last_row_px)
    : columns(rig.width_px / truth_block_px),
      rows(std::min(rig.height_px / truth_block_px, rig.scaled_row_px(last_row_px) / truth_block_px + 1)) {
  if (depths_m.empty()) depths_m.push_back(rig.detection_depth_m);
  for (const double asked_m : depths_m) depths.push_back(detection_depth(rig, asked_m));
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
  const auto nearest = std::ranges::min_element(depths, {}, [&](const DetectionDepth& depth) {
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

std::vector<ExpectedBlock> expected_blocks(const TrueImages& truth, const DetectionGrid& grid,
                                           std::optional<double> tolerance_m) {
  std::vector<ExpectedBlock> blocks;
  for (std::size_t depth = 0; depth < grid.depths.size(); ++depth) {
    DepthInterval interval = grid.depths[depth].one_pixel;
    const double depth_m = grid.depths[depth].depth_m;
    if (tolerance_m) interval = {depth_m - *tolerance_m, depth_m + *tolerance_m};
    for (int row = 0; row < grid.rows; ++row)
      for (int column = grid.first_column(depth); column < grid.columns; ++column) {
        const BlockContent content = content_between(truth, column * truth_block_px, row * truth_block_px,
                                                     interval, Surfaces::shared_obstacles);
        if (content.holds())
          blocks.push_back({row * grid.columns + column, depth, content.object, content.mean_depth_m});
      }
  }
  return blocks;
}

StereoHit hit_on_block(const StereoRig& rig, const DetectionDepth& depth, int column_px, int row_px) {
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
