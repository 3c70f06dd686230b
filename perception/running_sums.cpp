#include "perception/running_sums.hpp"

#include <algorithm>

#include "perception/block_score.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/running_sums.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <bool removes>
void MoveSums(const std::uint8_t* added, const std::uint8_t* removed, int count, std::uint16_t* even,
              std::uint16_t* odd) {
  const hn::ScalableTag<std::uint8_t> d;
  const hn::ScalableTag<std::uint16_t> d16;
  const auto low = hn::Set(d16, 0xFF);
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    const auto in = hn::BitCast(d16, hn::LoadU(d, added + x));
    auto even_sum = hn::Add(hn::LoadU(d16, even + x / 2), hn::And(in, low));
    auto odd_sum = hn::Add(hn::LoadU(d16, odd + x / 2), hn::ShiftRight<8>(in));
    if (removes) {
      const auto out = hn::BitCast(d16, hn::LoadU(d, removed + x));
      even_sum = hn::Sub(even_sum, hn::And(out, low));
      odd_sum = hn::Sub(odd_sum, hn::ShiftRight<8>(out));
    }
    hn::StoreU(even_sum, d16, even + x / 2);
    hn::StoreU(odd_sum, d16, odd + x / 2);
  }
}

void MoveDown(const std::uint8_t* added, const std::uint8_t* removed, int count, std::uint16_t* even,
              std::uint16_t* odd) {
  if (removed != nullptr) {
    MoveSums<true>(added, removed, count, even, odd);
  } else {
    MoveSums<false>(added, removed, count, even, odd);
  }
}

void DifferenceRow(const std::uint8_t* left, const std::uint8_t* right, int count, std::uint8_t* out) {
  const hn::ScalableTag<std::uint8_t> d;
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    const auto a = hn::LoadU(d, left + x), b = hn::LoadU(d, right + x);
    hn::StoreU(hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a)), d, out + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(MoveDown);
HWY_EXPORT(DifferenceRow);

}  // namespace

RunningSums::RunningSums(int width)
    : even_(static_cast<std::size_t>(width / 2 + over_read_px)), odd_(even_.size()) {}

void RunningSums::clear() {
  std::fill(even_.begin(), even_.end(), std::uint16_t{0});
  std::fill(odd_.begin(), odd_.end(), std::uint16_t{0});
}

void RunningSums::move(const std::uint8_t* added, const std::uint8_t* removed, int count) {
  HWY_DYNAMIC_DISPATCH(MoveDown)(added, removed, count, even_.data(), odd_.data());
}

void RunningSums::window_sums(int count, std::uint16_t* sums) const {
  block_sums(even_.data(), odd_.data(), count, sums);
}

void difference_row(const std::uint8_t* left, const std::uint8_t* right, int count, std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(DifferenceRow)(left, right, count, out);
}

}  // namespace understory
#endif  // HWY_ONCE
