#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// The whole-number arithmetic of block matching (Barry & Tedrake 2015; parameters from the original's public
/// code): sums and SAD of a block, the score test, and the rule that blocks must pass. Exact: no rounding
/// anywhere.
namespace understory {

inline constexpr int block_px = 5;  ///< blocks are 5x5 (Barry & Tedrake 2015)
inline constexpr int largest_edge_sum = 255 * block_px * block_px;

/// A score limit as a fraction of score_unit, so that the test is exact in integers. 333000 holds the
/// original's 54/333 and every limit of three decimals exactly.
inline constexpr std::int64_t score_unit = 333'000;
std::int64_t score_limit_units(double score_limit);

/// S < limit, that is SAD / edge_sum < limit, as score_unit * SAD < units * edge_sum.
inline bool scores_below(int sad, int edge_sum, std::int64_t limit_units) {
  return score_unit * sad < limit_units * edge_sum;
}

/// Sum of a 5x5 block; `top_left` is its first pixel.
int block_sum(const std::uint8_t* top_left, std::ptrdiff_t stride);
/// Sum of absolute differences of two 5x5 blocks.
int block_sad(const std::uint8_t* left, std::ptrdiff_t left_stride, const std::uint8_t* right,
              std::ptrdiff_t right_stride);

/// The paper's horizontal-invariance filter (Barry & Tedrake 2015): texture that repeats along the row also
/// matches where an infinitely distant point would lie, and then says nothing about depth.
struct SelfSimilarityWindow {
  int columns_each_side_px = 3;  ///< searched columns: -3 .. +3 (the original's public code)
  int rows_each_side_px = 8;     ///< searched rows: -8 .. +8
  int row_step_px = 2;           ///< in steps of 2
  int minimum_edge_sum = 860;    ///< of the right block, as for a hit
  std::int64_t limit_units = 0;  ///< reject at a score below this (see score_limit_units)
};

/// One disparity the detector looks at.
struct DisparityRule {
  int disparity_px = 0;          ///< x_left - x_right, whole pixels, inside the image
  int minimum_edge_sum = 0;      ///< of each image's block by itself; at most largest_edge_sum
  std::int64_t limit_units = 0;  ///< a hit scores below this (see score_limit_units)
};

/// The detector's rule in whole numbers: everything that is decided in pixels.
struct BlockRule {
  int width_px = 0, height_px = 0;
  int stride_px = block_px;  ///< from block to block, both ways
  int last_row_px = 0;       ///< top edge of the lowest blocks that may be looked at
  int right_margin_px = 0;   ///< columns at the end of a search that no block touches
  std::vector<DisparityRule> disparities;

  bool horizontal_invariance = false;
  int infinity_px = 0;  ///< disparity of the infinitely distant
  SelfSimilarityWindow window;

  bool uniqueness = false;
  int minimum_disparity_px = 0, maximum_disparity_px = 0;  ///< range searched, widened to hold the disparity
  double uniqueness_ratio = 2;

  bool neighbours = false;  ///< whether matches have the SAD at the disparities one pixel away
};

/// A block of the left image that passed.
struct BlockMatch {
  int column_px = 0, row_px = 0;  ///< top left pixel
  int disparity = 0;              ///< index into BlockRule::disparities
  int sad = 0;
  int left_edge_sum = 0, right_edge_sum = 0;
  /// SAD at the disparity one pixel less and more; -1 if not requested (neighbours) or outside the image.
  int sad_below = -1, sad_above = -1;
};

/// Where the blocks of one disparity lie: column x of a search is left_px + x and right_px + x, x < count.
struct SearchColumns {
  int left_px = 0, right_px = 0, count = 0;
};
SearchColumns search_columns(const BlockRule& rule, const DisparityRule& disparity);

/// The columns whose edges the rule looks at: from left_first_px on, and right_first_px .. right_last_px - 1.
struct EdgeColumns {
  int left_first_px = 0, right_first_px = 0, right_last_px = 0;
};
EdgeColumns edge_columns(const BlockRule& rule);

/// The columns of the images that affect the result: left_first_px .. left_last_px - 1 of the left.
struct ReadColumns {
  int left_first_px = 0, left_last_px = 0, right_first_px = 0, right_last_px = 0;
};
ReadColumns read_columns(const BlockRule& rule);

/// Rows at which blocks may begin: 0 .. this - 1.
int row_count(const BlockRule& rule);

/// Returns the rule. Asserts that it is valid: images of at least one block, disparities inside them, a
/// stride.
const BlockRule& sound(const BlockRule& rule);

}  // namespace understory
