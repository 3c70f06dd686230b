#pragma once

#include <cstdint>
#include <vector>

#include "perception/pushbroom/gray_view.hpp"

namespace understory {

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
