#pragma once

#include <cstdint>
#include <vector>

#include "perception/block_rule.hpp"
#include "perception/running_sums.hpp"

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
    EdgeMap differences;              ///< the last rows, by row modulo its height
    std::vector<std::uint64_t> best;  ///< of each cell of a row of cells, packed (dense_search.cpp)
  };
  /// Takes a row into the sums, and the row five above it out of them.
  void take_row_in(const GrayView& left, const GrayView& right, int row_px, bool is_first_window,
                   EdgeMap& right_edges);
  void take_candidates(int row_px, std::size_t disparity);
  void take_best(int first_row_px, std::vector<BlockMatch>& matches);

  BlockRule rule_;
  EdgeColumns edge_columns_;
  std::vector<Search> searches_;
  EdgeMap left_edges_;
  RunningSums left_running_, right_running_;
  StripReader left_reader_, right_reader_;
  std::vector<std::uint16_t> left_sums_, right_sums_, sads_;
  std::vector<std::uint64_t> candidates_;
};

}  // namespace understory
