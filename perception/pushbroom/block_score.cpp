#include "perception/pushbroom/block_score.hpp"

#include <cmath>
#include <cstdlib>

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

}  // namespace understory
