#pragma once

#include <cstdint>
#include <vector>

#include "perception/pushbroom/block_rule.hpp"
#include "perception/pushbroom/strip_sums.hpp"

namespace understory {

/// Looks at the blocks of a grid: one block every stride_px, the paper's way. Finds those whose edges and
/// score pass, filters aside.
class StripSearch {
 public:
  explicit StripSearch(const BlockRule& rule);

  /// Appends the matches of the blocks that begin at row_px, by disparity, then column. `from_afar`: see
  /// PushbroomKernel::search. Where `right_edges` is given, the right image's edges go there, five rows.
  void search(const GrayView& left, const GrayView& right, int row_px, bool from_afar, EdgeMap* right_edges,
              std::vector<BlockMatch>& matches);

 private:
  struct Search {
    SearchColumns columns;
    CandidateTest test;
    std::vector<std::uint64_t> blocks;  ///< bit x: a block begins at x
  };
  void take_candidates(const GrayView& left, const GrayView& right, int row_px, std::size_t disparity,
                       std::vector<BlockMatch>& matches) const;

  BlockRule rule_;
  EdgeColumns edge_columns_;
  std::vector<Search> searches_;
  StripReader left_reader_, right_reader_;
  std::vector<std::uint16_t> column_scratch_, left_sums_, right_sums_, sads_;
  std::vector<std::uint8_t> column_sads_;
  std::vector<std::uint64_t> candidates_;
};

}  // namespace understory
