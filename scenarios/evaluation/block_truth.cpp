#include "scenarios/evaluation/block_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace understory {
namespace {

constexpr int first_obstacle = 2;

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

BlockContent content_between(const TrueImages& truth, int column_px, int row_px, DepthInterval depths,
                             bool obstacles_only) {
  const auto near_mm = static_cast<int>(std::lround(std::clamp(1000 * depths.near_m, 1.0, 65535.0)));
  const auto far_mm = static_cast<int>(std::lround(std::clamp(1000 * depths.far_m, 0.0, 65535.0)));
  BlockContent content;
  std::array<int, truth_block_px * truth_block_px> objects;
  std::int64_t sum_mm = 0;
  for (int v = row_px; v < row_px + truth_block_px; ++v) {
    const auto* depth_mm = truth.depth_mm.ptr<std::uint16_t>(v);
    const auto* object = truth.objects.empty() ? nullptr : truth.objects.ptr<std::uint16_t>(v);
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

}  // namespace understory
