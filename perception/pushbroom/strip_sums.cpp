#include "perception/pushbroom/strip_sums.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/pushbroom/strip_sums.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

#include "perception/pushbroom/edges-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

// even[i], odd[i]: sums of the five rows' edges in the columns first + 2 i and first + 2 i + 1. Bytes widen
// most cheaply to 16 bits in this order.
template <bool keep_edges>
void StripColumnSums(const StripRows& rows, int first_px, int last_px, std::uint16_t* even,
                     std::uint16_t* odd, std::uint8_t* edges, std::ptrdiff_t edge_stride) {
  const Bytes d;
  const Words d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int u = first_px; u < last_px; u += lanes) {
    Corners before = corners_at(rows.row[0] + u), here = corners_at(rows.row[1] + u);
    auto pair_sum = hn::Zero(d16), odd_sum = hn::Zero(d16);  // of even + 256 odd, modulo 2^16
    for (int v = 0; v < block_px; ++v) {
      const Corners after = corners_at(rows.row[v + 2] + u);
      const ByteVector edge = edges_of(before, hn::LoadU(d, rows.row[v + 1] + u), after);
      if (keep_edges) hn::StoreU(edge, d, edges + v * edge_stride + u);
      const auto pairs = hn::BitCast(d16, edge);
      pair_sum = hn::Add(pair_sum, pairs);
      odd_sum = hn::Add(odd_sum, hn::ShiftRight<8>(pairs));
      before = here;
      here = after;
    }
    hn::StoreU(hn::Sub(pair_sum, hn::ShiftLeft<8>(odd_sum)), d16, even + (u - first_px) / 2);
    hn::StoreU(odd_sum, d16, odd + (u - first_px) / 2);
  }
}

void ColumnSums(const StripRows& rows, int first_px, int last_px, std::uint16_t* even, std::uint16_t* odd,
                std::uint8_t* edges, std::ptrdiff_t edge_stride) {
  if (edges != nullptr) {
    StripColumnSums<true>(rows, first_px, last_px, even, odd, edges, edge_stride);
  } else {
    StripColumnSums<false>(rows, first_px, last_px, even, odd, edges, edge_stride);
  }
}

// sums[x] = the five columns from x on, out of the even and the odd ones.
void BlockSums(const std::uint16_t* even, const std::uint16_t* odd, int count, std::uint16_t* sums) {
  const Words d16;
  const int lanes = static_cast<int>(hn::Lanes(d16));
  for (int i = 0; 2 * i < count; i += lanes) {
    const WindowSums windows = window_sums(even, odd, i);
    hn::StoreInterleaved2(windows.even, windows.odd, d16, sums + 2 * i);
  }
}

void EdgeRow(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int first_px,
             int last_px, std::uint8_t* edges) {
  const Bytes d;
  for (int u = first_px; u < last_px; u += static_cast<int>(hn::Lanes(d))) {
    hn::StoreU(edges_of(corners_at(above + u), hn::LoadU(d, here + u), corners_at(below + u)), d, edges + u);
  }
}

void ColumnSads(const StripRows& left, int left_px, const StripRows& right, int right_px, int count,
                std::uint8_t* sads) {
  const Bytes d;
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    ByteVector sum = hn::Zero(d);
    for (int v = 1; v <= block_px; ++v) {
      sum = hn::SaturatedAdd(sum, difference(hn::LoadU(d, left.row[v] + left_px + x),
                                             hn::LoadU(d, right.row[v] + right_px + x)));
    }
    hn::StoreU(sum, d, sads + x);
  }
}

// sads[x] = the five columns from x on.
void SumColumns(const std::uint8_t* column_sads, int count, std::uint16_t* sads) {
  const Words d16;
  const hn::Rebind<std::uint8_t, Words> half;
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d16))) {
    auto sad = hn::PromoteTo(d16, hn::LoadU(half, column_sads + x));
    for (int i = 1; i < block_px; ++i)
      sad = hn::Add(sad, hn::PromoteTo(d16, hn::LoadU(half, column_sads + x + i)));
    hn::StoreU(sad, d16, sads + x);
  }
}

void TestBlocks(const std::uint16_t* sads, const std::uint16_t* left_sums, const std::uint16_t* right_sums,
                int count, const CandidateTest& test, std::uint8_t* candidates) {
  const Words d16;
  const VectorTest vectors = vector_test(test);
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d16))) {
    const auto left = hn::LoadU(d16, left_sums + x), right = hn::LoadU(d16, right_sums + x);
    const auto pass = may_pass(vectors, hn::LoadU(d16, sads + x), left, right, hn::Add(left, right));
    hn::StoreMaskBits(hn::RebindToSigned<Words>(), pass, candidates + x / 8);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(ColumnSums);
HWY_EXPORT(BlockSums);
HWY_EXPORT(EdgeRow);
HWY_EXPORT(ColumnSads);
HWY_EXPORT(SumColumns);
HWY_EXPORT(TestBlocks);

}  // namespace

StripRows StripReader::rows(const GrayView& image, int row_px) {
  const int last = image.height_px - 1;
  const auto mirrored = [last](int row) {
    return std::clamp(row < 0 ? -row : row > last ? 2 * last - row : row, 0, last);
  };
  StripRows rows;
  // A read past a row's end reads the rows that follow, of which there must be enough.
  const std::ptrdiff_t spare = (last - (row_px + block_px)) * image.stride;
  if (row_px > 1 && spare >= over_read_px) {
    for (int i = 0; i < strip_row_count; ++i) rows.row[i] = image.row(row_px - 1 + i);
    return rows;
  }
  const std::size_t stride = static_cast<std::size_t>(image.width_px) + over_read_px + 1;
  copy_.resize(strip_row_count * stride + 1);
  for (int i = 0; i < strip_row_count; ++i) {
    std::uint8_t* row = copy_.data() + 1 + static_cast<std::size_t>(i) * stride;
    std::memcpy(row, image.row(mirrored(row_px - 1 + i)), static_cast<std::size_t>(image.width_px));
    rows.row[i] = row;
  }
  return rows;
}

void strip_edge_sums(const StripRows& rows, int first_px, int last_px, int width_px,
                     std::vector<std::uint16_t>& column_scratch, std::uint16_t* sums, EdgeMap* edges,
                     int row_px) {
  const std::size_t half = static_cast<std::size_t>(width_px) / 2 + over_read_px;
  if (column_scratch.size() < 2 * half) column_scratch.resize(2 * half);
  std::uint16_t* even = column_scratch.data();
  std::uint16_t* odd = even + half;
  std::uint8_t* edge_rows = edges != nullptr ? edges->row(row_px) : nullptr;
  const std::ptrdiff_t edge_stride = edges != nullptr ? edges->stride() : 0;
  HWY_DYNAMIC_DISPATCH(ColumnSums)(rows, first_px, last_px, even, odd, edge_rows, edge_stride);
  for (const int column_px : {0, width_px - 1}) {
    if (column_px < first_px || column_px >= last_px) continue;
    int sum = 0;
    for (int v = 0; v < block_px; ++v) {
      const std::uint8_t edge =
          outermost_edge(rows.row[v], rows.row[v + 1], rows.row[v + 2], column_px, width_px);
      if (edge_rows != nullptr) edge_rows[v * edge_stride + column_px] = edge;
      sum += edge;
    }
    const int x = column_px - first_px;
    (x % 2 == 0 ? even : odd)[x / 2] = static_cast<std::uint16_t>(sum);
  }
  HWY_DYNAMIC_DISPATCH(BlockSums)(even, odd, last_px - first_px, sums + first_px);
}

void edge_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int first_px,
              int last_px, int width_px, std::uint8_t* edges) {
  HWY_DYNAMIC_DISPATCH(EdgeRow)(above, here, below, first_px, last_px, edges);
  if (first_px == 0) edges[0] = outermost_edge(above, here, below, 0, width_px);
  if (last_px == width_px) edges[width_px - 1] = outermost_edge(above, here, below, width_px - 1, width_px);
}

CandidateTest candidate_test(int minimum_edge_sum, std::int64_t limit_units) {
  constexpr std::int64_t shares = 16384;
  CandidateTest test;
  test.minimum_edge_sum = minimum_edge_sum;
  test.any_score = 2 * limit_units > 5 * score_unit;
  test.limit_share = test.any_score
                         ? std::uint16_t{0}
                         : static_cast<std::uint16_t>((limit_units * shares + score_unit - 1) / score_unit);
  return test;
}

void strip_sads(const StripRows& left, int left_px, const StripRows& right, int right_px, int count,
                std::uint8_t* column_sads, std::uint16_t* sads) {
  HWY_DYNAMIC_DISPATCH(ColumnSads)(left, left_px, right, right_px, count, column_sads);
  HWY_DYNAMIC_DISPATCH(SumColumns)(column_sads, count, sads);
}

void find_candidates(const std::uint16_t* sads, const std::uint16_t* left_sums,
                     const std::uint16_t* right_sums, int count, const CandidateTest& test,
                     std::uint64_t* candidates) {
  HWY_DYNAMIC_DISPATCH(TestBlocks)
  (sads, left_sums, right_sums, count, test, reinterpret_cast<std::uint8_t*>(candidates));
}

}  // namespace understory
#endif  // HWY_ONCE
