// The Laplacian of bytes, sums of windows and the test of candidates, for the files that Highway builds once
// for each instruction set. Included again for each, so the guard switches (Highway's convention).
#if defined(UNDERSTORY_EDGES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef UNDERSTORY_EDGES_INL_HPP
#undef UNDERSTORY_EDGES_INL_HPP
#else
#define UNDERSTORY_EDGES_INL_HPP
#endif

#include <hwy/highway.h>

#include "perception/pushbroom/strip_sums.hpp"

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Bytes = hn::ScalableTag<std::uint8_t>;
using Words = hn::ScalableTag<std::uint16_t>;
using ByteVector = hn::Vec<Bytes>;
using WordVector = hn::Vec<Words>;
using WordMask = hn::Mask<hn::RebindToSigned<Words>>;

// Half of a row's share of the four corners: the mean of the pixels to the left and right, rounded up, and
// whether it was rounded.
struct Corners {
  ByteVector mean, rounded;
};

HWY_INLINE Corners corners_at(const std::uint8_t* pixel) {
  const Bytes d;
  const ByteVector a = hn::LoadU(d, pixel - 1), b = hn::LoadU(d, pixel + 1);
  return {hn::AverageRound(a, b), hn::And(hn::Xor(a, b), hn::Set(d, 1))};
}

// The Laplacian in bytes, exactly. With M the mean of the two rows' means and e what the three roundings
// added, the four corners sum to 4 M - e, so the response is 2 (4 (M - c) - e). Where M <= c it is negative
// or zero, which is stored as 0; where M - c >= 64 it is stored as 255, and saturation keeps it there.
HWY_INLINE ByteVector edges_of(const Corners& above, ByteVector here, const Corners& below) {
  const Bytes d;
  const ByteVector mean = hn::AverageRound(above.mean, below.mean);
  const ByteVector rounded = hn::And(hn::Xor(above.mean, below.mean), hn::Set(d, 1));
  const ByteVector error = hn::Add(hn::Add(above.rounded, below.rounded), hn::Add(rounded, rounded));
  const ByteVector rise = hn::SaturatedSub(mean, here);
  const ByteVector twice = hn::SaturatedAdd(rise, rise);
  const ByteVector half = hn::SaturatedSub(hn::SaturatedAdd(twice, twice), error);
  return hn::SaturatedAdd(half, half);
}

HWY_INLINE ByteVector difference(ByteVector a, ByteVector b) {
  return hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
}

// Sums of five columns, beginning at columns 2 i and 2 i + 1; even[i] and odd[i] hold these two columns.
struct WindowSums {
  WordVector even, odd;
};

HWY_INLINE WindowSums window_sums(const std::uint16_t* even, const std::uint16_t* odd, int i) {
  const Words d16;
  const auto even_0 = hn::LoadU(d16, even + i), even_1 = hn::LoadU(d16, even + i + 1),
             even_2 = hn::LoadU(d16, even + i + 2);
  const auto odd_0 = hn::LoadU(d16, odd + i), odd_1 = hn::LoadU(d16, odd + i + 1),
             odd_2 = hn::LoadU(d16, odd + i + 2);
  const auto shared = hn::Add(hn::Add(odd_0, even_1), hn::Add(odd_1, even_2));
  return {hn::Add(even_0, shared), hn::Add(shared, odd_2)};
}

// CandidateTest in vectors.
struct VectorTest {
  hn::Vec<hn::RebindToSigned<Words>> less_than_edges;
  WordVector share, slack;
};

HWY_INLINE VectorTest vector_test(const CandidateTest& test) {
  const Words d16;
  const hn::RebindToSigned<Words> signed16;
  return {hn::Set(signed16, static_cast<std::int16_t>(test.minimum_edge_sum - 1)),
          hn::Set(d16, test.limit_share),
          hn::Set(d16, test.any_score ? std::uint16_t{largest_edge_sum} : std::uint16_t{0})};
}

// All sums are below 2^15, and AVX-512 lacks comparisons of unsigned words here.
HWY_INLINE WordMask may_pass(const VectorTest& test, WordVector sad, WordVector left, WordVector right,
                             WordVector both) {
  const hn::RebindToSigned<Words> signed16;
  const auto limit = hn::Add(hn::MulHigh(hn::ShiftLeft<2>(both), test.share), test.slack);
  const auto edges_pass = hn::Gt(hn::BitCast(signed16, hn::Min(left, right)), test.less_than_edges);
  const auto too_different = hn::Gt(hn::BitCast(signed16, sad), hn::BitCast(signed16, limit));
  return hn::AndNot(too_different, edges_pass);
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#endif
