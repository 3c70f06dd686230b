#include "tests/support/plain_pushbroom.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "perception/pushbroom/block_rule.hpp"

namespace understory::support {
namespace {

std::uint8_t saturate(int response) { return static_cast<std::uint8_t>(std::clamp(response, 0, 255)); }

int mirrored(int at, int count) { return at < 0 ? -at : at >= count ? 2 * (count - 1) - at : at; }

struct Images {
  GrayView left, right, left_edges, right_edges;
};

bool inside(const GrayView& image, int column_px, int row_px) {
  return column_px >= 0 && row_px >= 0 && column_px + block_px <= image.width_px &&
         row_px + block_px <= image.height_px;
}

int edges_at(const GrayView& edges, int column_px, int row_px) {
  return block_sum(edges.row(row_px) + column_px, edges.stride);
}

int sad_of(const Images& images, int column_px, int row_px, int right_column_px, int right_row_px) {
  return block_sad(images.left.row(row_px) + column_px, images.left.stride,
                   images.right.row(right_row_px) + right_column_px, images.right.stride);
}

bool repeats(const BlockRule& rule, const Images& images, const BlockMatch& match) {
  const SelfSimilarityWindow& window = rule.window;
  for (int dv = -window.rows_each_side_px; dv <= window.rows_each_side_px; dv += window.row_step_px)
    for (int du = -window.columns_each_side_px; du <= window.columns_each_side_px; ++du) {
      const int u = match.column_px - rule.infinity_px + du, v = match.row_px + dv;
      if (!inside(images.right, u, v)) return true;
      const int edges = edges_at(images.right_edges, u, v);
      if (edges >= window.minimum_edge_sum &&
          scores_below(sad_of(images, match.column_px, match.row_px, u, v), match.left_edge_sum + edges,
                       window.limit_units))
        return true;
    }
  // The window's last row and column count as part of it even where the steps do not reach them.
  return !inside(images.right, match.column_px - rule.infinity_px, match.row_px + window.rows_each_side_px);
}

bool unique(const BlockRule& rule, const Images& images, const BlockMatch& match) {
  const int detection = rule.disparities[static_cast<std::size_t>(match.disparity)].disparity_px;
  const auto thousandths = std::llround(1000 * rule.uniqueness_ratio);
  for (int d = std::min(detection, rule.minimum_disparity_px);
       d <= std::max(detection, rule.maximum_disparity_px); ++d) {
    if (d == detection || !inside(images.right, match.column_px - d, match.row_px)) continue;
    const int other = sad_of(images, match.column_px, match.row_px, match.column_px - d, match.row_px);
    if (std::abs(d - detection) == 1 ? other < match.sad : 1000LL * other <= thousandths * match.sad)
      return false;
  }
  return true;
}

void look_beside(const BlockRule& rule, const Images& images, BlockMatch& match) {
  const int detection = rule.disparities[static_cast<std::size_t>(match.disparity)].disparity_px;
  for (const int beside : {-1, 1}) {
    const int column_px = match.column_px - (detection + beside);
    const int sad = inside(images.right, column_px, match.row_px)
                        ? sad_of(images, match.column_px, match.row_px, column_px, match.row_px)
                        : -1;
    (beside < 0 ? match.sad_below : match.sad_above) = sad;
  }
}

}  // namespace

void edge_map(const GrayView& image, std::vector<std::uint8_t>& edges) {
  const int width = image.width_px, height = image.height_px;
  edges.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int v = 0; v < height; ++v) {
    const std::uint8_t* above = image.row(mirrored(v - 1, height));
    const std::uint8_t* below = image.row(mirrored(v + 1, height));
    for (int u = 0; u < width; ++u) {
      const int before = mirrored(u - 1, width), after = mirrored(u + 1, width);
      const int corners = above[before] + above[after] + below[before] + below[after];
      edges[static_cast<std::size_t>(v * width + u)] = saturate(2 * corners - 8 * image.row(v)[u]);
    }
  }
}

GrayView view_of(const std::vector<std::uint8_t>& packed, int width_px, int height_px) {
  return {packed.data(), width_px, width_px, height_px};
}

std::vector<BlockMatch> plain_matches(const BlockRule& rule, const GrayView& left, const GrayView& right) {
  std::vector<std::uint8_t> left_edges, right_edges;
  edge_map(left, left_edges);
  edge_map(right, right_edges);
  const Images images{left, right, view_of(left_edges, left.width_px, left.height_px),
                      view_of(right_edges, right.width_px, right.height_px)};
  const int stride = rule.stride_px;
  std::vector<BlockMatch> matches;
  for (int row = 0; row <= rule.last_row_px; row += stride)
    for (std::size_t i = 0; i < rule.disparities.size(); ++i)
      for (int column = 0; column < left.width_px; ++column) {
        const DisparityRule& one = rule.disparities[i];
        const int first = std::max(0, one.disparity_px), partner = column - one.disparity_px;
        if (column < first || (column - first) % stride != 0) continue;
        // The last block to be compared ends the margin before the image does, in whichever image ends first.
        const int margin = rule.right_margin_px;
        if (!inside(left, column + margin, row) || !inside(right, partner + margin, row)) continue;
        const BlockMatch match{column,
                               row,
                               static_cast<int>(i),
                               sad_of(images, column, row, partner, row),
                               edges_at(images.left_edges, column, row),
                               edges_at(images.right_edges, partner, row)};
        if (match.left_edge_sum < one.minimum_edge_sum || match.right_edge_sum < one.minimum_edge_sum)
          continue;
        if (!scores_below(match.sad, match.left_edge_sum + match.right_edge_sum, one.limit_units)) continue;
        matches.push_back(match);
      }
  std::erase_if(matches, [&](const BlockMatch& match) {
    return (rule.uniqueness && !unique(rule, images, match)) ||
           (rule.horizontal_invariance && repeats(rule, images, match));
  });
  if (rule.neighbours)
    for (BlockMatch& match : matches) look_beside(rule, images, match);
  return matches;
}

}  // namespace understory::support
