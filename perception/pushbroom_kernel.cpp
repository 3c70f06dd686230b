#include "perception/pushbroom_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "perception/assertion.hpp"

namespace understory {
namespace {

std::vector<std::uint64_t> block_bits(int count, int stride_px) {
  std::vector<std::uint64_t> bits(static_cast<std::size_t>(count) / 64 + 1, 0);
  for (int x = 0; x + block_px <= count; x += stride_px)
    bits[static_cast<std::size_t>(x) / 64] |= std::uint64_t{1} << (x % 64);
  return bits;
}

}  // namespace

PushbroomKernel::PushbroomKernel(const BlockRule& rule) : rule_(rule) {
  const int width = rule.width_px;
  assert_always(width >= block_px && rule.height_px >= block_px, "images must hold a block");
  assert_always(rule.stride_px > 0 && !rule.disparities.empty(), "a rule needs a stride and a disparity");
  strip_count_ = std::min(rule.last_row_px, rule.height_px - block_px) / rule.stride_px + 1;
  left_first_px_ = width;
  right_first_px_ = width;
  for (const DisparityRule& one : rule.disparities) {
    const int d = one.disparity_px;
    assert_always(std::abs(d) + block_px <= width, "disparity wider than the image");
    const int count = width - std::abs(d);
    searches_.push_back({std::max(0, d),
                         std::max(0, -d),
                         count,
                         candidate_test(one.least_edge_sum, one.limit_units),
                         block_bits(count, rule.stride_px),
                         {d, std::min(d, rule.least_disparity_px), std::max(d, rule.greatest_disparity_px),
                          rule.uniqueness_ratio}});
    left_first_px_ = std::min(left_first_px_, std::max(0, d));
    right_first_px_ = std::min(right_first_px_, std::max(0, -d));
    right_last_px_ = std::max(right_last_px_, std::max(0, -d) + count);
  }
  if (rule.horizontal_invariance) {  // its window around infinity looks at right blocks beyond the matches
    right_first_px_ = 0;
    right_last_px_ =
        std::clamp(width - rule.infinity_px + rule.window.columns_each_side_px, right_last_px_, width);
  }
  const auto padded = static_cast<std::size_t>(width + 2 * over_read_px);
  left_sums_.resize(padded);
  right_sums_.resize(padded);
  column_sads_.resize(padded);
  candidates_.resize(padded / 64 + 1);
  right_edges_.resize(static_cast<std::size_t>(width + over_read_px) *
                      static_cast<std::size_t>(rule.height_px));
}

const std::vector<BlockMatch>& PushbroomKernel::search(const GrayView& left, const GrayView& right,
                                                       int first_strip, int last_strip) {
  matches_.clear();
  for (int strip = first_strip; strip < last_strip; ++strip)
    search_strip(left, right, strip * rule_.stride_px);
  if (rule_.horizontal_invariance && !matches_.empty())
    fill_right_edges(right, first_strip * rule_.stride_px, (last_strip - 1) * rule_.stride_px);
  if (rule_.horizontal_invariance || rule_.uniqueness) drop_unlike_the_rule(left, right);
  return matches_;
}

void PushbroomKernel::search_strip(const GrayView& left, const GrayView& right, int row_px) {
  const StripRows left_rows = left_reader_.rows(left, row_px), right_rows = right_reader_.rows(right, row_px);
  EdgeRows edges;
  if (rule_.horizontal_invariance) {
    edges.stride = rule_.width_px + over_read_px;
    edges.first = right_edges_.data() + row_px * edges.stride;
  }
  strip_edge_sums(left_rows, left_first_px_, rule_.width_px, rule_.width_px, column_scratch_,
                  left_sums_.data(), {});
  strip_edge_sums(right_rows, right_first_px_, right_last_px_, rule_.width_px, column_scratch_,
                  right_sums_.data(), edges);
  const std::size_t first_match = matches_.size();
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    const Search& search = searches_[i];
    strip_candidates(left_rows, search.left_px, right_rows, search.right_px, search.count, left_sums_.data(),
                     right_sums_.data(), search.test, column_sads_.data(),
                     reinterpret_cast<std::uint8_t*>(candidates_.data()));
    take_candidates(left, right, row_px, static_cast<int>(i));
  }
  if (searches_.size() > 1)
    std::sort(matches_.begin() + static_cast<std::ptrdiff_t>(first_match), matches_.end(),
              [](const BlockMatch& a, const BlockMatch& b) {
                return a.column_px != b.column_px ? a.column_px < b.column_px : a.disparity < b.disparity;
              });
}

void PushbroomKernel::take_candidates(const GrayView& left, const GrayView& right, int row_px,
                                      int disparity) {
  const Search& search = searches_[static_cast<std::size_t>(disparity)];
  const std::int64_t limit_units = rule_.disparities[static_cast<std::size_t>(disparity)].limit_units;
  for (std::size_t word = 0; word < search.blocks.size(); ++word) {
    std::uint64_t bits = candidates_[word] & search.blocks[word];
    for (; bits != 0; bits &= bits - 1) {
      const int x = static_cast<int>(64 * word) + std::countr_zero(bits);
      BlockMatch match{search.left_px + x,
                       row_px,
                       disparity,
                       0,
                       left_sums_[static_cast<std::size_t>(search.left_px + x)],
                       right_sums_[static_cast<std::size_t>(search.right_px + x)]};
      const std::uint8_t* columns = column_sads_.data() + x;
      match.sad = columns[0] + columns[1] + columns[2] + columns[3] + columns[4];
      if (std::count(columns, columns + block_px, 255) > 0)  // saturated: at least this much
        match.sad = block_sad(left.row(row_px) + match.column_px, left.stride,
                              right.row(row_px) + search.right_px + x, right.stride);
      if (scores_below(match.sad, match.left_edge_sum + match.right_edge_sum, limit_units))
        matches_.push_back(match);
    }
  }
}

// Rows of the edge map that the strips have not left behind: those of the window above and below, and those
// between strips that stand apart.
void PushbroomKernel::fill_right_edges(const GrayView& right, int first_row_px, int last_row_px) {
  const int reach = rule_.window.rows_each_side_px;
  const int first = std::max(0, first_row_px - reach);
  const int last = std::min(rule_.height_px - 1, last_row_px + block_px - 1 + reach);
  for (int v = first; v <= last; ++v) {
    const int into = v - first_row_px;
    if (into >= 0 && v < last_row_px + block_px && into % rule_.stride_px < block_px) continue;
    const StripRows rows = right_reader_.rows(right, v);
    edge_row(rows.row[0], rows.row[1], rows.row[2], right_first_px_, right_last_px_, rule_.width_px,
             right_edges_.data() + static_cast<std::ptrdiff_t>(v) * (rule_.width_px + over_read_px));
  }
}

void PushbroomKernel::drop_unlike_the_rule(const GrayView& left, const GrayView& right) {
  const GrayView right_edges{right_edges_.data(), rule_.width_px + over_read_px, rule_.width_px,
                             rule_.height_px};
  const auto fails = [&](const BlockMatch& match) {
    if (rule_.uniqueness && !searches_[static_cast<std::size_t>(match.disparity)].uniqueness.unique(
                                left, right, match.column_px, match.row_px))
      return true;
    return rule_.horizontal_invariance &&
           self_similar(left, right, right_edges, match.column_px, match.row_px,
                        match.column_px - rule_.infinity_px, match.left_edge_sum, rule_.window);
  };
  matches_.erase(std::remove_if(matches_.begin(), matches_.end(), fails), matches_.end());
}

}  // namespace understory
