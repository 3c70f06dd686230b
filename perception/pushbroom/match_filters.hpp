#pragma once

#include <cstdint>
#include <vector>

#include "perception/gray_view.hpp"
#include "perception/pushbroom/block_rule.hpp"

namespace understory {

/// Drops matches whose left block also matches a right block of the window around its place at infinity. A
/// window that leaves the image counts as similar, because it cannot be tested.
class SelfSimilarityFilter {
 public:
  SelfSimilarityFilter(const SelfSimilarityWindow& window, int infinity_px);

  /// `right_edges` is the right image's edge map. The remaining matches keep their order.
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

/// Whether one disparity stands out along the row: its SAD is a local minimum, and no other disparity of the
/// range comes within `ratio` times it. Neighbours one pixel away share most of the match, so they only have
/// to be no better. (The idea is StereoBM's uniqueness ratio; the figures are those of docs/sources.md [16]
/// on rendered forests.)
class UniquenessTest {
 public:
  /// Range in whole pixels, both ends included, with the detection's disparity inside; ratio >= 1.
  UniquenessTest(int detection_disparity_px, int minimum_disparity_px, int maximum_disparity_px,
                 double ratio);

  /// The left block at (column, row), whose right partner at the detection disparity lies inside the image.
  /// Disparities whose right block leaves the image are left out.
  bool unique(const GrayView& left, const GrayView& right, int column_px, int row_px);

 private:
  int detection_px_, minimum_px_, maximum_px_;
  std::int64_t ratio_thousandths_;   // whole numbers, so that every machine decides alike
  std::vector<std::uint16_t> sads_;  // by right column, ascending
};

}  // namespace understory
