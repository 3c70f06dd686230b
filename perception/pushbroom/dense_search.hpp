#pragma once

#include <cstdint>
#include <vector>

#include "perception/pushbroom/block_rule.hpp"
#include "perception/pushbroom/strip_sums.hpp"

/// The dense detector. Its inner loops (running_sums.cpp) sum the 5x5 windows at every pixel, five rows of
/// windows at a time, in portable SIMD. Exact.
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

/// Looks at a window at every pixel and keeps the best of each cell of 5x5 windows: more to match for the
/// same number of hits, and hits that sit on the texture instead of on a grid.
class DenseSearch {
 public:
  explicit DenseSearch(const BlockRule& rule);

  /// Appends the best match of each cell whose windows begin at the rows first_row_px .. last_row_px - 1
  /// (whole rows of cells), by row of cells, then disparity, then cell. The edges of the right image go to
  /// `right_edges`, rows first_row_px .. last_row_px + 3.
  void search(const GrayView& left, const GrayView& right, int first_row_px, int last_row_px,
              EdgeMap& right_edges, std::vector<BlockMatch>& matches);

 private:
  struct Search {
    SearchColumns columns;
    CandidateTest test;
    RunningSums sums;                 ///< of the differences
    EdgeMap differences;              ///< the last five rows, by row modulo five
    std::vector<std::uint64_t> best;  ///< of each cell of a row of cells, packed (dense_search.cpp)
  };
  /// Takes `count` rows into the sums, and those five above them out.
  void take_rows_in(const GrayView& left, const GrayView& right, int row_px, int count, int first_row_px,
                    EdgeMap& right_edges);
  void take_candidates(Search& search, int window_row);
  void take_best(const Search& search, int row_px, int disparity, std::vector<BlockMatch>& matches);
  /// The image's columns where a search begins, among the sums' columns.
  ColumnSumRow left_sums(const Search& search, int window_row) const;
  ColumnSumRow right_sums(const Search& search, int window_row) const;

  BlockRule rule_;
  EdgeColumns edge_columns_;
  std::vector<Search> searches_;
  EdgeMap left_edges_;  ///< the last five rows, by row modulo five
  RunningSums left_running_, right_running_;
  StripReader left_reader_, right_reader_;
  std::vector<std::uint8_t> nothing_;  ///< a row of zeros
  WindowRow windows_;
  std::vector<int> cells_;
};

}  // namespace understory
