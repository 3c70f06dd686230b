#pragma once

#include <cstdint>
#include <vector>

#include "perception/pushbroom/block_rule.hpp"
#include "perception/pushbroom/running_sums.hpp"

namespace understory {

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
