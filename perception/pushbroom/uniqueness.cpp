#include "perception/pushbroom/match_filters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "perception/assertion.hpp"
#include "perception/pushbroom/block_rule.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/pushbroom/uniqueness.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// sads[i] = SAD of the block with the right block i columns further, for i < count and up to a vector beyond.
void RowSads(const std::uint8_t* block, std::ptrdiff_t left_stride, const std::uint8_t* search,
             std::ptrdiff_t right_stride, int count, std::uint16_t* sads) {
  const hn::ScalableTag<std::uint8_t> d;
  const hn::ScalableTag<std::uint16_t> d16;
  const auto low = hn::Set(d16, 0xFF);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    auto even = hn::Zero(d16), odd = hn::Zero(d16);
    for (int v = 0; v < block_px; ++v)
      for (int u = 0; u < block_px; ++u) {
        const auto here = hn::Set(d, block[v * left_stride + u]);
        const auto there = hn::LoadU(d, search + v * right_stride + i + u);
        const auto pairs =
            hn::BitCast(d16, hn::Or(hn::SaturatedSub(here, there), hn::SaturatedSub(there, here)));
        even = hn::Add(even, hn::And(pairs, low));
        odd = hn::Add(odd, hn::ShiftRight<8>(pairs));
      }
    hn::StoreInterleaved2(even, odd, d16, sads + i);
  }
}

// The SADs of the block with the right blocks 0, 1 and 2 columns further.
void NeighbourSads(const std::uint8_t* block, std::ptrdiff_t left_stride, const std::uint8_t* search,
                   std::ptrdiff_t right_stride, std::uint64_t* sads) {
  const hn::Full128<std::uint8_t> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  // A block's row of five bytes, at column 0 and 1, 2 and 3, in groups of eight; 128 gives zero.
  alignas(16) constexpr std::uint8_t same[] = {0, 1, 2, 3, 4, 128, 128, 128, 0, 1, 2, 3, 4, 128, 128, 128};
  alignas(16) constexpr std::uint8_t low[] = {0, 1, 2, 3, 4, 128, 128, 128, 1, 2, 3, 4, 5, 128, 128, 128};
  alignas(16) constexpr std::uint8_t high[] = {2, 3, 4, 5, 6, 128, 128, 128, 3, 4, 5, 6, 7, 128, 128, 128};
  auto first = hn::Zero(d64), second = hn::Zero(d64);
  for (int v = 0; v < block_px; ++v) {
    const auto here = hn::TableLookupBytesOr0(hn::LoadU(d, block + v * left_stride), hn::Load(d, same));
    const auto row = hn::LoadU(d, search + v * right_stride);
    const auto a = hn::TableLookupBytesOr0(row, hn::Load(d, low));
    const auto b = hn::TableLookupBytesOr0(row, hn::Load(d, high));
    first = hn::Add(first, hn::SumsOf8(hn::Or(hn::SaturatedSub(here, a), hn::SaturatedSub(a, here))));
    second = hn::Add(second, hn::SumsOf8(hn::Or(hn::SaturatedSub(here, b), hn::SaturatedSub(b, here))));
  }
  hn::StoreU(first, d64, sads);
  hn::StoreU(second, d64, sads + 2);
}

// Whether one of the sads is at most `limit`.
bool AnyAtMost(const std::uint16_t* sads, int count, std::uint16_t limit) {
  const hn::ScalableTag<std::uint16_t> d16;
  auto minimum = hn::Set(d16, std::uint16_t{65535});
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d16)))
    minimum = hn::Min(minimum, hn::LoadU(d16, sads + i));
  return !hn::AllFalse(d16, hn::Eq(hn::SaturatedSub(minimum, hn::Set(d16, limit)), hn::Zero(d16)));
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(RowSads);
HWY_EXPORT(NeighbourSads);
HWY_EXPORT(AnyAtMost);

constexpr int over_read_px = 128;  // a vector of loads, and one of stores, past the last column searched

}  // namespace

UniquenessTest::UniquenessTest(int detection_disparity_px, int minimum_disparity_px, int maximum_disparity_px,
                               double ratio)
    : detection_px_(detection_disparity_px),
      minimum_px_(minimum_disparity_px),
      maximum_px_(maximum_disparity_px),
      ratio_thousandths_(std::llround(1000 * ratio)) {
  assert_always(minimum_px_ <= detection_px_ && detection_px_ <= maximum_px_,
                "detection disparity outside the range");
  assert_always(ratio >= 1.0, "uniqueness ratio below 1");
  sads_.resize(static_cast<std::size_t>(maximum_px_ - minimum_px_ + 1 + over_read_px));
}

bool UniquenessTest::unique(const GrayView& left, const GrayView& right, int column_px, int row_px) {
  // A greater disparity is a smaller right column; columns run upwards so that loads read forwards.
  const int first = std::max(0, column_px - maximum_px_);
  const int last = std::min(right.width_px - block_px, column_px - minimum_px_);
  const int count = last - first + 1;
  const int chosen = column_px - detection_px_ - first;
  assert_always(chosen >= 0 && chosen < count, "the right block lies outside the image");
  const std::uint8_t* block = left.row(row_px) + column_px;
  const std::uint8_t* search = right.row(row_px) + first;
  // Most candidates fail against a neighbour, which costs three blocks; only the rest search the row.
  std::uint64_t sads[4] = {};
  constexpr int load_bytes = 16;
  const int last_row = row_px + block_px - 1;
  if (chosen > 0 && chosen + 1 < count && left.can_read(column_px, last_row, load_bytes) &&
      right.can_read(first + chosen - 1, last_row, load_bytes)) {
    HWY_DYNAMIC_DISPATCH(NeighbourSads)(block, left.stride, search + chosen - 1, right.stride, sads);
  } else {
    for (const int i : {0, 1, 2}) {
      const int at =
          std::clamp(chosen - 1 + i, 0, count - 1);  // beyond the range: the block itself, or its like
      sads[i] = static_cast<std::uint64_t>(block_sad(block, left.stride, search + at, right.stride));
    }
  }
  const auto best = static_cast<int>(sads[1]);
  if (sads[0] < sads[1] || sads[2] < sads[1]) return false;

  if (right.can_read(first, row_px + block_px - 1, count + over_read_px)) {
    HWY_DYNAMIC_DISPATCH(RowSads)(block, left.stride, search, right.stride, count, sads_.data());
  } else {
    for (int i = 0; i < count; ++i)
      sads_[static_cast<std::size_t>(i)] =
          static_cast<std::uint16_t>(block_sad(block, left.stride, search + i, right.stride));
  }
  const auto limit =
      static_cast<std::uint16_t>(std::min<std::int64_t>(ratio_thousandths_ * best / 1000, 65534));
  const auto unlike = std::uint16_t{65535};
  for (int i = std::max(0, chosen - 1); i <= std::min(count - 1, chosen + 1); ++i)
    sads_[static_cast<std::size_t>(i)] = unlike;
  std::fill_n(sads_.begin() + count, over_read_px / 2, unlike);
  return !HWY_DYNAMIC_DISPATCH(AnyAtMost)(sads_.data(), count, limit);
}

}  // namespace understory
#endif  // HWY_ONCE
