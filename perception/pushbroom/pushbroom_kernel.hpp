#pragma once

#include <vector>

#include "perception/pushbroom/block_rule.hpp"
#include "perception/pushbroom/match_filters.hpp"
#include "perception/pushbroom/strip_sums.hpp"

namespace understory {

/// Looks at the blocks of a grid: one block every stride_px, the paper's way. Finds those whose edges and
/// score pass, without the filters.
class StripSearch {
 public:
  explicit StripSearch(const BlockRule& rule);

  /// Appends the matches of the blocks that begin at row_px, by disparity, then column. `from_afar`: see
  /// PushbroomKernel::search. If `right_edges` is given, five rows of the right image's edges are written
  /// there.
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

/// Finds the blocks that pass a rule: pointer and stride in, whole numbers out, no image library. The same
/// matches, bit for bit, on every instruction set. Owns the buffers it needs: for several threads, one kernel
/// each, over strips of their own. Allocates only if there are more matches than ever before.
class PushbroomKernel {
 public:
  /// Asserts that the rule is sound.
  explicit PushbroomKernel(const BlockRule& rule);

  /// Rows of blocks in an image.
  int strip_count() const;

  /// The matches of the strips first_strip .. last_strip - 1, by strip, then disparity, then column. The
  /// images have the rule's size. With `from_afar` the images are in no cache, so rows are prefetched; for
  /// images that were just written, that would take 5 % longer. The answer holds until the next call.
  const std::vector<BlockMatch>& search(const GrayView& left, const GrayView& right, int first_strip,
                                        int last_strip, bool from_afar = true);

 private:
  void fill_right_edges(const GrayView& right, int first_row_px, int end_row_px);
  void drop_unlike_the_rule(const GrayView& left, const GrayView& right);
  void look_beside(const GrayView& left, const GrayView& right);

  BlockRule rule_;
  StripSearch strips_;
  std::vector<UniquenessTest> uniqueness_;  ///< one for each disparity
  SelfSimilarityFilter self_similarity_;
  StripReader right_reader_;
  EdgeMap right_edges_;
  std::vector<BlockMatch> matches_;
};

}  // namespace understory
