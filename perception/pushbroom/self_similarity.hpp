#pragma once

#include <cstdint>
#include <vector>

#include "perception/pushbroom/gray_view.hpp"

namespace understory {

/// The paper's horizontal-invariance filter (Barry & Tedrake 2015): texture that repeats along the row also
/// matches where an infinitely distant point would lie, and then says nothing about depth.
struct SelfSimilarityWindow {
  int columns_each_side_px = 3;  ///< searched columns: -3 .. +3 (the original's public code)
  int rows_each_side_px = 8;     ///< searched rows: -8 .. +8
  int row_step_px = 2;           ///< in steps of 2
  int minimum_edge_sum = 860;    ///< of the right block, as for a hit
  std::int64_t limit_units = 0;  ///< reject at a score below this (see score_limit_units)
};

struct BlockMatch;

/// Drops matches whose left block also matches a right block of the window around its place at infinity. A
/// window that leaves the image counts as similar: nothing can be said there.
class SelfSimilarityFilter {
 public:
  SelfSimilarityFilter(const SelfSimilarityWindow& window, int infinity_px);

  /// `right_edges` is the right image's edge map. The matches left keep their order.
  void drop_similar(const GrayView& left, const GrayView& right, const GrayView& right_edges,
                    std::vector<BlockMatch>& matches);

  /// A left block, its window's first column and row in the right image and its edge map, its match.
  struct Task {
    const std::uint8_t* block = nullptr;
    const std::uint8_t* right = nullptr;
    const std::uint8_t* right_edges = nullptr;
    int left_edge_sum = 0;
    int match = 0;  ///< index
  };

 private:
  SelfSimilarityWindow window_;
  int infinity_px_;
  std::vector<Task> tasks_;
  std::vector<std::uint8_t> unlike_;  ///< of each match: nothing similar was found
};

}  // namespace understory
