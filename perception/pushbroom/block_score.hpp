#pragma once

#include <cstddef>
#include <cstdint>

/// The whole-number arithmetic of block matching (Barry & Tedrake 2015; parameters from the original's public
/// code): sums and SAD of a block, and the score test. Exact: no rounding anywhere.
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

}  // namespace understory
