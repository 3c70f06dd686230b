#pragma once

#include <cstdint>
#include <vector>

#include "perception/pushbroom/block_score.hpp"
#include "perception/pushbroom/strip_sums.hpp"

/// The dense detector's inner loops: sums of the 5x5 windows at every pixel, five rows of windows at a time,
/// in portable SIMD. Exact.
namespace understory {

/// A row of column sums: of the columns 2 i and of the columns 2 i + 1, the order in which bytes widen most
/// cheaply to 16 bits.
struct ColumnSumRow {
  const std::uint16_t* even = nullptr;
  const std::uint16_t* odd = nullptr;
};
/// The same from column `first` on.
inline ColumnSumRow from_column(const ColumnSumRow& row, int first) {
  if (first % 2 == 0) return {row.even + first / 2, row.odd + first / 2};
  return {row.odd + first / 2, row.even + first / 2 + 1};
}
/// The five columns from x on.
inline int window_sum(const ColumnSumRow& row, int x) {
  const auto [first, second] = from_column(row, x);
  return first[0] + second[0] + first[1] + second[1] + first[2];
}

/// Rows of bytes that come into the sums, and rows that leave them, which may lie in the same places.
struct MovedRows {
  std::uint8_t* added[block_px] = {};
  const std::uint8_t* removed[block_px] = {};
  int count = 0;
};

/// Sums of five rows in each column of a byte image, moved down up to five rows at a time. Loads and stores
/// run up to over_read_px past the last column, of the rows of bytes too.
class RunningSums {
 public:
  /// For rows of up to `width` columns.
  explicit RunningSums(int width);
  /// To sums of nothing.
  void clear();
  /// Takes in the edges of the rows 1 .. count of `rows`, columns first_px .. last_px - 1, and keeps them in
  /// moved.added. Column first_px is the sums' column 0; `width_px` is the image's, whose outermost columns
  /// mirror.
  void take_edges(const StripRows& rows, int first_px, int last_px, int width_px, const MovedRows& moved);
  /// Takes in |left - right| of the rows 1 .. count, `columns` columns from left_px and right_px on, and
  /// keeps them in moved.added.
  void take_differences(const StripRows& left, int left_px, const StripRows& right, int right_px, int columns,
                        const MovedRows& moved);
  /// The sums after `index` + 1 of the rows last taken in.
  ColumnSumRow row(int index) const { return {even(index), odd(index)}; }

 private:
  const std::uint16_t* even(int index) const { return sums_.data() + 2 * index * half_width_; }
  const std::uint16_t* odd(int index) const { return even(index) + half_width_; }

  std::ptrdiff_t half_width_;
  AlignedVector<std::uint16_t> sums_;  ///< of each row the even, then the odd columns
  int last_ = 0;                       ///< row whose sums go on
};

/// What the windows of a row sum to, and which may pass: those at 2 i in [0], at 2 i + 1 in [1].
struct WindowRow {
  AlignedVector<std::uint16_t> sads[2], edges[2];  ///< both images' edges
  AlignedVector<std::uint64_t> bits[2];            ///< bit i
  std::vector<std::uint16_t> candidates;           ///< x of those that may pass, the even ones first
  explicit WindowRow(int width);
};

/// Sums the windows at x = 0 .. count - 5 and tests them; the answer is how many candidates there are. Each
/// row starts with column 0 of the windows.
int test_windows(const ColumnSumRow& sads, const ColumnSumRow& left_edges, const ColumnSumRow& right_edges,
                 int count, const CandidateTest& test, WindowRow& windows);

}  // namespace understory
