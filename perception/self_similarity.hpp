#pragma once

#include <cstdint>

#include "perception/gray_view.hpp"

namespace understory {

/// The paper's horizontal-invariance filter (Barry & Tedrake 2015): texture that repeats along the row also
/// matches where an infinitely distant point would lie, and then says nothing about depth.
struct SelfSimilarityWindow {
  int columns_each_side_px = 3;  ///< searched columns: -3 .. +3 (the original's public code)
  int rows_each_side_px = 8;     ///< searched rows: -8 .. +8
  int row_step_px = 2;           ///< in steps of 2
  int least_edge_sum = 860;      ///< of the right block, as for a hit
  std::int64_t limit_units = 0;  ///< reject at a score below this (see score_limit_units)
};

/// True where the left block at (column, row), whose edges sum to `left_edge_sum`, also matches a right block
/// of the window around (infinity_column, row). A window that leaves the image counts as similar: nothing can
/// be said there.
bool self_similar(const GrayView& left, const GrayView& right, const GrayView& right_edges, int column_px,
                  int row_px, int infinity_column_px, int left_edge_sum, const SelfSimilarityWindow& window);

}  // namespace understory
