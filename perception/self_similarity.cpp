#include "perception/self_similarity.hpp"

#include "perception/block_score.hpp"

namespace understory {
namespace {

bool window_inside(const GrayView& image, int column_px, int row_px, const SelfSimilarityWindow& window) {
  return column_px - window.columns_each_side_px >= 0 && row_px - window.rows_each_side_px >= 0 &&
         column_px + window.columns_each_side_px + block_px <= image.width_px &&
         row_px + window.rows_each_side_px + block_px <= image.height_px;
}

}  // namespace

bool self_similar(const GrayView& left, const GrayView& right, const GrayView& right_edges, int column_px,
                  int row_px, int infinity_column_px, int left_edge_sum, const SelfSimilarityWindow& window) {
  if (!window_inside(right, infinity_column_px, row_px, window)) return true;
  const std::uint8_t* block = left.row(row_px) + column_px;
  for (int dv = -window.rows_each_side_px; dv <= window.rows_each_side_px; dv += window.row_step_px) {
    for (int du = -window.columns_each_side_px; du <= window.columns_each_side_px; ++du) {
      const int u = infinity_column_px + du, v = row_px + dv;
      const int sad = block_sad(block, left.stride, right.row(v) + u, right.stride);
      // Most blocks fail even with the strongest edges there could be: their edges need not be summed.
      if (!scores_below(sad, left_edge_sum + largest_edge_sum, window.limit_units)) continue;
      const int right_edge_sum = block_sum(right_edges.row(v) + u, right_edges.stride);
      if (right_edge_sum >= window.least_edge_sum &&
          scores_below(sad, left_edge_sum + right_edge_sum, window.limit_units))
        return true;
    }
  }
  return false;
}

}  // namespace understory
