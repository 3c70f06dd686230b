#include "perception/pushbroom/block_rule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "perception/assertion.hpp"

namespace understory {

std::int64_t score_limit_units(double score_limit) {
  return std::llround(score_limit * static_cast<double>(score_unit));
}

int block_sum(const std::uint8_t* top_left, std::ptrdiff_t stride) {
  int sum = 0;
  for (int v = 0; v < block_px; ++v, top_left += stride)
    for (int u = 0; u < block_px; ++u) sum += top_left[u];
  return sum;
}

int block_sad(const std::uint8_t* left, std::ptrdiff_t left_stride, const std::uint8_t* right,
              std::ptrdiff_t right_stride) {
  int sad = 0;
  for (int v = 0; v < block_px; ++v, left += left_stride, right += right_stride)
    for (int u = 0; u < block_px; ++u) sad += std::abs(left[u] - right[u]);
  return sad;
}

SearchColumns search_columns(const BlockRule& rule, const DisparityRule& disparity) {
  const int d = disparity.disparity_px;
  return {std::max(0, d), std::max(0, -d), rule.width_px - std::abs(d) - rule.right_margin_px};
}

EdgeColumns edge_columns(const BlockRule& rule) {
  EdgeColumns columns{rule.width_px, rule.width_px, 0};
  for (const DisparityRule& one : rule.disparities) {
    const SearchColumns search = search_columns(rule, one);
    columns.left_first_px = std::min(columns.left_first_px, search.left_px);
    columns.right_first_px = std::min(columns.right_first_px, search.right_px);
    columns.right_last_px = std::max(columns.right_last_px, search.right_px + search.count);
  }
  if (rule.horizontal_invariance) {  // its window around infinity lies beyond the matches
    columns.right_first_px = 0;
    columns.right_last_px = std::clamp(rule.width_px - rule.infinity_px + rule.window.columns_each_side_px,
                                       columns.right_last_px, rule.width_px);
  }
  return columns;
}

ReadColumns read_columns(const BlockRule& rule) {
  const EdgeColumns edges = edge_columns(rule);
  // A pixel's edge depends on those beside it, and BlockRule::neighbours looks a pixel further.
  ReadColumns columns{edges.left_first_px - 1, rule.width_px, edges.right_first_px - 1,
                      edges.right_last_px + 1};
  if (rule.uniqueness) {
    columns.right_first_px = 0;
    for (const DisparityRule& one : rule.disparities)
      columns.right_last_px = std::max(columns.right_last_px,
                                       rule.width_px - std::min(one.disparity_px, rule.minimum_disparity_px));
  }
  for (int* column_px : {&columns.left_first_px, &columns.right_first_px, &columns.right_last_px})
    *column_px = std::clamp(*column_px, 0, rule.width_px);
  return columns;
}

int row_count(const BlockRule& rule) { return std::min(rule.last_row_px, rule.height_px - block_px) + 1; }

const BlockRule& sound(const BlockRule& rule) {
  assert_always(rule.width_px >= block_px && rule.height_px >= block_px, "images must hold a block");
  assert_always(rule.stride_px > 0 && rule.last_row_px >= 0, "blocks need a stride and a first row");
  assert_always(rule.right_margin_px >= 0, "a margin lies inside the image");
  assert_always(!rule.disparities.empty(), "a rule needs a disparity");
  for (const DisparityRule& one : rule.disparities)
    assert_always(std::abs(one.disparity_px) + rule.right_margin_px + block_px <= rule.width_px,
                  "disparity wider than the image");
  return rule;
}

}  // namespace understory
