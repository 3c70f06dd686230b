#pragma once

#include <cstdint>
#include <vector>

#include "perception/gray_view.hpp"

/// The whole-number arithmetic of block matching (Barry & Tedrake 2015; parameters from the original's public
/// code): edge map, edge sum and SAD of a block, and the score test. Exact: no rounding anywhere.
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

/// The Laplacian of kernel size 3, kernel [2 0 2; 0 -8 0; 2 0 2], borders mirrored about the outermost pixel,
/// saturated to 8 bits (negative responses become 0, large ones 255): what cv::Laplacian(..., CV_8U, 3)
/// gives. `edges` is resized to width * height, rows packed. Images are at least 2x2.
void edge_map(const GrayView& image, std::vector<std::uint8_t>& edges);
GrayView view_of(const std::vector<std::uint8_t>& packed, int width_px, int height_px);

/// Sum of a 5x5 block; `top_left` is its first pixel.
int block_sum(const std::uint8_t* top_left, std::ptrdiff_t stride);
/// Sum of absolute differences of two 5x5 blocks.
int block_sad(const std::uint8_t* left, std::ptrdiff_t left_stride, const std::uint8_t* right,
              std::ptrdiff_t right_stride);

/// sums[u] = sum of the five pixels (u, row_px) ... (u, row_px + 4): a row of blocks shares these running
/// sums.
void column_sums(const GrayView& image, int row_px, std::vector<std::uint16_t>& sums);

}  // namespace understory
