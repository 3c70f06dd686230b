#include "perception/pushbroom/pushbroom_kernel.hpp"

#include <algorithm>

namespace understory {

PushbroomKernel::PushbroomKernel(const BlockRule& rule)
    : rule_(rule), self_similarity_(rule.window, rule.infinity_px) {
  assert_sound(rule);
  if (rule.every_pixel) {
    rule_.stride_px = block_px;  // of the cells
    dense_.emplace(rule_);
  } else {
    strips_.emplace(rule_);
  }
  for (const DisparityRule& one : rule.disparities)
    uniqueness_.emplace_back(one.disparity_px, std::min(one.disparity_px, rule.minimum_disparity_px),
                             std::max(one.disparity_px, rule.maximum_disparity_px), rule.uniqueness_ratio);
  if (rule.every_pixel || rule.horizontal_invariance) right_edges_ = EdgeMap(rule.width_px, rule.height_px);
}

int PushbroomKernel::strip_count() const { return (row_count(rule_) - 1) / rule_.stride_px + 1; }

const std::vector<BlockMatch>& PushbroomKernel::search(const GrayView& left, const GrayView& right,
                                                       int first_strip, int last_strip, bool from_afar) {
  matches_.clear();
  if (first_strip >= last_strip) return matches_;
  const int first_row = first_strip * rule_.stride_px, last_row = (last_strip - 1) * rule_.stride_px;
  if (dense_) {
    dense_->search(left, right, first_row, std::min(last_row + block_px, row_count(rule_)), right_edges_,
                   matches_);
  } else {
    for (int row = first_row; row <= last_row; row += rule_.stride_px)
      strips_->search(left, right, row, from_afar, rule_.horizontal_invariance ? &right_edges_ : nullptr,
                      matches_);
  }
  if (rule_.horizontal_invariance && !matches_.empty())
    fill_right_edges(right, first_row, std::min(last_row + block_px, rule_.height_px));
  if (rule_.horizontal_invariance || rule_.uniqueness) drop_unlike_the_rule(left, right);
  if (rule_.neighbours) look_beside(left, right);
  return matches_;
}

// Rows of the edge map that the search has not left behind: those of the window above and below, and those
// between strips that stand apart.
void PushbroomKernel::fill_right_edges(const GrayView& right, int first_row_px, int end_row_px) {
  const EdgeColumns columns = edge_columns(rule_);
  const int reach = rule_.window.rows_each_side_px;
  for (int v = std::max(0, first_row_px - reach);
       v < std::min(rule_.height_px, end_row_px + block_px - 1 + reach); ++v) {
    const bool inside = v >= first_row_px && v < end_row_px;
    if (inside && (v - first_row_px) % rule_.stride_px < block_px) continue;
    const StripRows rows = right_reader_.rows(right, v);
    edge_row(rows.row[0], rows.row[1], rows.row[2], columns.right_first_px, columns.right_last_px,
             rule_.width_px, right_edges_.row(v));
  }
}

void PushbroomKernel::look_beside(const GrayView& left, const GrayView& right) {
  for (BlockMatch& match : matches_) {
    const int disparity_px = rule_.disparities[static_cast<std::size_t>(match.disparity)].disparity_px;
    const auto sad_at = [&](int at_px) {
      const int column_px = match.column_px - at_px;
      if (column_px < 0 || column_px + block_px > rule_.width_px) return -1;
      return block_sad(left.row(match.row_px) + match.column_px, left.stride,
                       right.row(match.row_px) + column_px, right.stride);
    };
    match.sad_below = sad_at(disparity_px - 1);
    match.sad_above = sad_at(disparity_px + 1);
  }
}

void PushbroomKernel::drop_unlike_the_rule(const GrayView& left, const GrayView& right) {
  if (rule_.uniqueness) {
    const auto fails = [&](const BlockMatch& match) {
      UniquenessTest& uniqueness = uniqueness_[static_cast<std::size_t>(match.disparity)];
      return !uniqueness.unique(left, right, match.column_px, match.row_px);
    };
    matches_.erase(std::remove_if(matches_.begin(), matches_.end(), fails), matches_.end());
  }
  if (rule_.horizontal_invariance) self_similarity_.drop_similar(left, right, right_edges_.view(), matches_);
}

}  // namespace understory
