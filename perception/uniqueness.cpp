#include "perception/uniqueness.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "perception/assertion.hpp"
#include "perception/block_score.hpp"

namespace understory {
namespace {

std::uint8_t difference(std::uint8_t a, std::uint8_t b) {
  return static_cast<std::uint8_t>(std::max(a, b) - std::min(a, b));
}

/// sad[i] += the differences of one row of the left block with the right block's i columns further: a loop
/// over columns, in bytes, which the compiler vectorises.
void add_row(const std::uint8_t* left, const std::uint8_t* right, int count, std::uint16_t* __restrict sad) {
  static_assert(block_px == 5);
  const std::uint8_t l0 = left[0], l1 = left[1], l2 = left[2], l3 = left[3], l4 = left[4];
  for (int i = 0; i < count; ++i) {
    sad[i] = static_cast<std::uint16_t>(sad[i] + difference(l0, right[i]) + difference(l1, right[i + 1]) +
                                        difference(l2, right[i + 2]) + difference(l3, right[i + 3]) +
                                        difference(l4, right[i + 4]));
  }
}

}  // namespace

UniquenessTest::UniquenessTest(int detection_disparity_px, int least_disparity_px, int greatest_disparity_px,
                               double ratio)
    : detection_px_(detection_disparity_px),
      least_px_(least_disparity_px),
      greatest_px_(greatest_disparity_px),
      ratio_thousandths_(std::llround(1000 * ratio)) {
  assert_always(least_px_ <= detection_px_ && detection_px_ <= greatest_px_,
                "detection disparity outside the range");
  assert_always(ratio >= 1.0, "uniqueness ratio below 1");
}

bool UniquenessTest::unique(const GrayView& left, const GrayView& right, int column_px, int row_px) {
  // A greater disparity is a smaller right column; columns run upwards so that the inner loop reads forwards.
  const int first = std::max(0, column_px - greatest_px_);
  const int last = std::min(right.width_px - block_px, column_px - least_px_);
  const int count = last - first + 1;
  const int chosen = column_px - detection_px_ - first;
  assert_always(chosen >= 0 && chosen < count, "the right block lies outside the image");
  const std::uint8_t* block = left.row(row_px) + column_px;
  const std::uint8_t* search = right.row(row_px) + first;
  // Most candidates fail against a neighbour, which costs two blocks; only the rest search the row.
  const int best = block_sad(block, left.stride, search + chosen, right.stride);
  for (const int i : {chosen - 1, chosen + 1})
    if (i >= 0 && i < count && block_sad(block, left.stride, search + i, right.stride) < best) return false;
  fill_sad(block, left.stride, search, right.stride, count);
  for (int i = 0; i < count; ++i)
    if (std::abs(i - chosen) > 1 &&
        std::int64_t{1000} * sad_[static_cast<std::size_t>(i)] <= ratio_thousandths_ * best)
      return false;
  return true;
}

void UniquenessTest::fill_sad(const std::uint8_t* block, std::ptrdiff_t left_stride,
                              const std::uint8_t* search, std::ptrdiff_t right_stride, int count) {
  sad_.assign(static_cast<std::size_t>(count), 0);
  for (int v = 0; v < block_px; ++v, block += left_stride, search += right_stride)
    add_row(block, search, count, sad_.data());
}

}  // namespace understory
