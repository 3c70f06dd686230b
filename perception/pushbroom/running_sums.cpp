#include "perception/pushbroom/dense_search.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/pushbroom/running_sums.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

#include "perception/pushbroom/edges-inl.hpp"

#ifndef UNDERSTORY_RUNNING_SUMS_ONCE
#define UNDERSTORY_RUNNING_SUMS_ONCE
namespace understory {

// The sums of a row, to be written.
struct SumRow {
  std::uint16_t* even = nullptr;
  std::uint16_t* odd = nullptr;
};
// Where the sums go on from, and where those after each row go.
struct SumRows {
  ColumnSumRow before;
  SumRow after[block_px];
};

}  // namespace understory
#endif

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

// Column sums of one vector of columns, on their way down.
class MovingSums {
 public:
  HWY_INLINE MovingSums(const ColumnSumRow& before, int x)
      : even_(hn::LoadU(Words(), before.even + x / 2)), odd_(hn::LoadU(Words(), before.odd + x / 2)) {}
  HWY_INLINE void move(ByteVector added, ByteVector removed, const SumRow& sums, int x) {
    const Words d16;
    const auto low = hn::Set(d16, 0xFF);
    const auto in = hn::BitCast(d16, added), out = hn::BitCast(d16, removed);
    even_ = hn::Sub(hn::Add(even_, hn::And(in, low)), hn::And(out, low));
    odd_ = hn::Sub(hn::Add(odd_, hn::ShiftRight<8>(in)), hn::ShiftRight<8>(out));
    hn::StoreU(even_, d16, sums.even + x / 2);
    hn::StoreU(odd_, d16, sums.odd + x / 2);
  }

 private:
  WordVector even_, odd_;
};

void TakeEdges(const StripRows& rows, int first_px, int count_px, const MovedRows& moved,
               const SumRows& sums) {
  const Bytes d;
  for (int x = 0; x < count_px; x += static_cast<int>(hn::Lanes(d))) {
    const int u = first_px + x;
    MovingSums moving(sums.before, x);
    Corners before = corners_at(rows.row[0] + u), here = corners_at(rows.row[1] + u);
    for (int v = 0; v < moved.count; ++v) {
      const Corners after = corners_at(rows.row[v + 2] + u);
      const ByteVector edges = edges_of(before, hn::LoadU(d, rows.row[v + 1] + u), after);
      const ByteVector removed = hn::LoadU(d, moved.removed[v] + x);
      hn::StoreU(edges, d, moved.added[v] + x);
      moving.move(edges, removed, sums.after[v], x);
      before = here;
      here = after;
    }
  }
}

void TakeDifferences(const StripRows& left, int left_px, const StripRows& right, int right_px, int columns,
                     const MovedRows& moved, const SumRows& sums) {
  const Bytes d;
  for (int x = 0; x < columns; x += static_cast<int>(hn::Lanes(d))) {
    MovingSums moving(sums.before, x);
    for (int v = 0; v < moved.count; ++v) {
      const ByteVector added = difference(hn::LoadU(d, left.row[v + 1] + left_px + x),
                                          hn::LoadU(d, right.row[v + 1] + right_px + x));
      const ByteVector removed = hn::LoadU(d, moved.removed[v] + x);
      hn::StoreU(added, d, moved.added[v] + x);
      moving.move(added, removed, sums.after[v], x);
    }
  }
}

// Appends the bits' numbers, times two and `parity`, to `list`, and up to four more that mean nothing. Four
// at a time without asking, since how many there are cannot be foreseen.
HWY_INLINE std::uint16_t* ListBits(std::uint64_t bits, int first, int parity, std::uint16_t* list) {
  const auto count = static_cast<std::ptrdiff_t>(hwy::PopCount(bits));
  std::ptrdiff_t done = 0;
  do {
    for (int k = 0; k < 4; ++k) {
      list[done + k] = static_cast<std::uint16_t>(2 * (first + std::countr_zero(bits)) + parity);
      bits &= bits - 1;
    }
    done += 4;
  } while (done < count);
  return list + count;
}

int TestWindows(const ColumnSumRow& sads, const ColumnSumRow& left_edges, const ColumnSumRow& right_edges,
                int count, const CandidateTest& asked, WindowRow& windows) {
  const Words d16;
  const hn::RebindToSigned<Words> signed16;
  const VectorTest test = vector_test(asked);
  std::uint16_t *even_sads = windows.sads[0].data(), *odd_sads = windows.sads[1].data();
  std::uint16_t *even_edges = windows.edges[0].data(), *odd_edges = windows.edges[1].data();
  auto* even_bits = reinterpret_cast<std::uint8_t*>(windows.bits[0].data());
  auto* odd_bits = reinterpret_cast<std::uint8_t*>(windows.bits[1].data());
  const ColumnSumRow sad_row = sads, left_row = left_edges, right_row = right_edges;
  for (int i = 0; 2 * i < count; i += static_cast<int>(hn::Lanes(d16))) {
    const WindowSums sad = window_sums(sad_row.even, sad_row.odd, i),
                     left = window_sums(left_row.even, left_row.odd, i),
                     right = window_sums(right_row.even, right_row.odd, i);
    const auto even_both = hn::Add(left.even, right.even), odd_both = hn::Add(left.odd, right.odd);
    hn::StoreU(sad.even, d16, even_sads + i);
    hn::StoreU(sad.odd, d16, odd_sads + i);
    hn::StoreU(even_both, d16, even_edges + i);
    hn::StoreU(odd_both, d16, odd_edges + i);
    hn::StoreMaskBits(signed16, may_pass(test, sad.even, left.even, right.even, even_both),
                      even_bits + i / 8);
    hn::StoreMaskBits(signed16, may_pass(test, sad.odd, left.odd, right.odd, odd_both), odd_bits + i / 8);
  }
  std::uint16_t* const list = windows.candidates.data();
  std::uint16_t* end = list;
  for (int parity = 0; parity < 2; ++parity) {
    const int places = (count - block_px - parity + 2) / 2;
    for (int first = 0; first < places; first += 64) {
      std::uint64_t bits = windows.bits[parity][static_cast<std::size_t>(first) / 64];
      if (places - first < 64) bits &= (std::uint64_t{1} << (places - first)) - 1;
      end = ListBits(bits, first, parity, end);
    }
  }
  return static_cast<int>(end - list);
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(TakeEdges);
HWY_EXPORT(TakeDifferences);
HWY_EXPORT(TestWindows);

SumRows sum_rows(std::uint16_t* sums, std::ptrdiff_t half_width, int last) {
  SumRows rows;
  for (int v = 0; v < block_px; ++v)
    rows.after[v] = {sums + 2 * v * half_width, sums + (2 * v + 1) * half_width};
  rows.before = {rows.after[last].even, rows.after[last].odd};
  return rows;
}

}  // namespace

RunningSums::RunningSums(int width)
    : half_width_(whole_lines(width + 2 * over_read_px) / 2),
      sums_(static_cast<std::size_t>(2 * block_px * half_width_)) {}

void RunningSums::clear() {
  std::fill(sums_.begin(), sums_.end(), std::uint16_t{0});
  last_ = 0;
}

void RunningSums::take_edges(const StripRows& rows, int first_px, int last_px, int width_px,
                             const MovedRows& moved) {
  const SumRows sums = sum_rows(sums_.data(), half_width_, last_);
  HWY_DYNAMIC_DISPATCH(TakeEdges)(rows, first_px, last_px - first_px, moved, sums);
  for (const int column_px : {0, width_px - 1}) {
    if (column_px < first_px || column_px >= last_px) continue;
    const int x = column_px - first_px;
    int wrong = 0;  // what the sums lack
    for (int v = 0; v < moved.count; ++v) {
      const std::uint8_t edge =
          outermost_edge(rows.row[v], rows.row[v + 1], rows.row[v + 2], column_px, width_px);
      wrong += edge - moved.added[v][x];
      moved.added[v][x] = edge;
      std::uint16_t& sum = (x % 2 == 0 ? sums.after[v].even : sums.after[v].odd)[x / 2];
      sum = static_cast<std::uint16_t>(sum + wrong);
    }
  }
  last_ = moved.count - 1;
}

void RunningSums::take_differences(const StripRows& left, int left_px, const StripRows& right, int right_px,
                                   int columns, const MovedRows& moved) {
  HWY_DYNAMIC_DISPATCH(TakeDifferences)
  (left, left_px, right, right_px, columns, moved, sum_rows(sums_.data(), half_width_, last_));
  last_ = moved.count - 1;
}

WindowRow::WindowRow(int width) {
  const auto half = static_cast<std::size_t>(width / 2 + over_read_px);
  for (int parity = 0; parity < 2; ++parity) {
    sads[parity].resize(half);
    edges[parity].resize(half);
    bits[parity].resize(half / 64 + 2);
  }
  candidates.resize(static_cast<std::size_t>(width + over_read_px));
}

int test_windows(const ColumnSumRow& sads, const ColumnSumRow& left_edges, const ColumnSumRow& right_edges,
                 int count, const CandidateTest& test, WindowRow& windows) {
  return HWY_DYNAMIC_DISPATCH(TestWindows)(sads, left_edges, right_edges, count, test, windows);
}

}  // namespace understory
#endif  // HWY_ONCE
