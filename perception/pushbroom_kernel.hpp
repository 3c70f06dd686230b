#pragma once

#include <cstdint>
#include <vector>

#include "perception/block_score.hpp"
#include "perception/gray_view.hpp"
#include "perception/self_similarity.hpp"
#include "perception/strip_sums.hpp"
#include "perception/uniqueness.hpp"

namespace understory {

/// One disparity the detector looks at.
struct DisparityRule {
  int disparity_px = 0;          ///< x_left - x_right, whole pixels, inside the image
  int least_edge_sum = 0;        ///< of each image's block by itself; at most largest_edge_sum
  std::int64_t limit_units = 0;  ///< a hit scores below this (see score_limit_units)
};

/// The detector's rule in whole numbers: everything that is decided in pixels.
struct BlockRule {
  int width_px = 0, height_px = 0;
  int stride_px = block_px;  ///< from block to block, both ways
  int last_row_px = 0;       ///< top edge of the lowest blocks that may be looked at
  std::vector<DisparityRule> disparities;

  bool horizontal_invariance = false;
  int infinity_px = 0;  ///< disparity of the infinitely distant
  SelfSimilarityWindow window;

  bool uniqueness = false;
  int least_disparity_px = 0, greatest_disparity_px = 0;  ///< range searched; holds every disparity
  double uniqueness_ratio = 2;
};

/// A block of the left image that passed the rule.
struct BlockMatch {
  int column_px = 0, row_px = 0;  ///< top left pixel
  int disparity = 0;              ///< index into BlockRule::disparities
  int sad = 0;
  int left_edge_sum = 0, right_edge_sum = 0;
};

/// Finds the blocks that pass a rule: pointer and stride in, whole numbers out, no image library. The same
/// matches, bit for bit, on every instruction set. Owns the buffers it needs: for several threads, one kernel
/// each, over strips of their own. Allocates nothing once it has seen as many matches as it will.
class PushbroomKernel {
 public:
  /// Asserts that the rule makes sense: sizes of at least one block, disparities inside the image.
  explicit PushbroomKernel(const BlockRule& rule);

  /// Rows of blocks in an image.
  int strip_count() const { return strip_count_; }

  /// The matches of the strips first_strip .. last_strip - 1, by row, then column, then disparity. The images
  /// have the rule's size. The answer holds until the next call.
  const std::vector<BlockMatch>& search(const GrayView& left, const GrayView& right, int first_strip,
                                        int last_strip);

 private:
  /// Where a disparity's blocks lie: column x of the search is left_px + x and right_px + x.
  struct Search {
    int left_px = 0, right_px = 0, count = 0;
    CandidateTest test;
    std::vector<std::uint64_t> blocks;  ///< bit x: a block begins at x
    UniquenessTest uniqueness;
  };
  void search_strip(const GrayView& left, const GrayView& right, int row_px);
  void take_candidates(const GrayView& left, const GrayView& right, int row_px, int disparity);
  void fill_right_edges(const GrayView& right, int first_row_px, int last_row_px);
  void drop_unlike_the_rule(const GrayView& left, const GrayView& right);

  BlockRule rule_;
  int strip_count_ = 0;
  int left_first_px_ = 0, right_first_px_ = 0, right_last_px_ = 0;  ///< columns whose edges are needed
  std::vector<Search> searches_;
  StripReader left_reader_, right_reader_;
  std::vector<std::uint16_t> column_scratch_, left_sums_, right_sums_;
  std::vector<std::uint8_t> column_sads_;
  std::vector<std::uint64_t> candidates_;
  std::vector<std::uint8_t> right_edges_;  ///< edge map of the right image, over_read_px spare columns
  std::vector<BlockMatch> matches_;
};

}  // namespace understory
