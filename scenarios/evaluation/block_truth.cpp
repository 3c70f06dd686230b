#include "scenarios/evaluation/block_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace understory {
namespace {

constexpr int first_obstacle = 2;

/// The commonest of the numbers, the smaller where two are as common.
int commonest(std::array<int, truth_block_px * truth_block_px>& numbers, int count) {
  const auto end = numbers.begin() + count;
  std::sort(numbers.begin(), end);
  int best = 0;
  std::ptrdiff_t maximum = 0;
  for (auto from = numbers.begin(); from != end;) {
    const auto to = std::upper_bound(from, end, *from);
    if (to - from > maximum) {
      maximum = to - from;
      best = *from;
    }
    from = to;
  }
  return best;
}

/// Counts pixels of `depth_image`.
BlockContent content_of(const cv::Mat& depth_image, const cv::Mat& objects_image, int column_px, int row_px,
                        DepthInterval depths, bool obstacles_only) {
  const auto near_mm = static_cast<int>(std::lround(std::clamp(1000 * depths.near_m, 1.0, 65535.0)));
  const auto far_mm = static_cast<int>(std::lround(std::clamp(1000 * depths.far_m, 0.0, 65535.0)));
  BlockContent content;
  std::array<int, truth_block_px * truth_block_px> objects;
  std::int64_t sum_mm = 0;
  for (int v = row_px; v < row_px + truth_block_px; ++v) {
    const auto* depth_mm = depth_image.ptr<std::uint16_t>(v);
    const auto* object = objects_image.empty() ? nullptr : objects_image.ptr<std::uint16_t>(v);
    for (int u = column_px; u < column_px + truth_block_px; ++u) {
      if (depth_mm[u] < near_mm || depth_mm[u] > far_mm) continue;
      if (obstacles_only && object != nullptr && object[u] < first_obstacle) continue;
      objects[static_cast<std::size_t>(content.pixels++)] = object != nullptr ? object[u] : 0;
      sum_mm += depth_mm[u];
    }
  }
  if (content.pixels == 0) return content;
  content.object = commonest(objects, content.pixels);
  content.mean_depth_m = 1e-3 * static_cast<double>(sum_mm) / content.pixels;
  return content;
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
                             bool obstacles_only) {
  return content_of(truth.depth_mm, truth.objects, column_px, row_px, depths, obstacles_only);
}

BlockContent shared_between(const TrueImages& truth, int column_px, int row_px, DepthInterval depths) {
  return content_of(truth.shared_depth_mm, truth.objects, column_px, row_px, depths, true);
}

}  // namespace understory
