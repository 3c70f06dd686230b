#include "perception/pushbroom/pushbroom_kernel.hpp"

#include <algorithm>
#include <bit>

namespace understory {
namespace {

std::vector<std::uint64_t> block_bits(int count, int stride_px) {
  std::vector<std::uint64_t> bits(static_cast<std::size_t>(count) / 64 + 1, 0);
  for (int x = 0; x + block_px <= count; x += stride_px)
    bits[static_cast<std::size_t>(x) / 64] |= std::uint64_t{1} << (x % 64);
  return bits;
}

}  // namespace

StripSearch::StripSearch(const BlockRule& rule) : rule_(rule), edge_columns_(edge_columns(rule)) {
  for (const DisparityRule& one : rule.disparities) {
    const SearchColumns columns = search_columns(rule, one);
    searches_.push_back({columns, candidate_test(one.minimum_edge_sum, one.limit_units),
                         block_bits(columns.count, rule.stride_px)});
  }
  const auto padded = static_cast<std::size_t>(rule.width_px + 2 * over_read_px);
  for (auto* sums : {&left_sums_, &right_sums_, &sads_}) sums->resize(padded);
  column_sads_.resize(padded);
  candidates_.resize(padded / 64 + 1);
}

void StripSearch::search(const GrayView& left, const GrayView& right, int row_px, bool from_afar,
                         EdgeMap* right_edges, std::vector<BlockMatch>& matches) {
  if (from_afar) {
    constexpr int ahead = 4;  // strips: about as long as memory takes to answer
    left.prefetch(row_px + ahead * rule_.stride_px, rule_.stride_px);
    right.prefetch(row_px + ahead * rule_.stride_px, rule_.stride_px);
  }
  const StripRows left_rows = left_reader_.rows(left, row_px), right_rows = right_reader_.rows(right, row_px);
  strip_edge_sums(left_rows, edge_columns_.left_first_px, rule_.width_px, rule_.width_px, column_scratch_,
                  left_sums_.data(), nullptr, 0);
  strip_edge_sums(right_rows, edge_columns_.right_first_px, edge_columns_.right_last_px, rule_.width_px,
                  column_scratch_, right_sums_.data(), right_edges, row_px);
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    const auto& [columns, test, blocks] = searches_[i];
    strip_sads(left_rows, columns.left_px, right_rows, columns.right_px, columns.count, column_sads_.data(),
               sads_.data());
    find_candidates(sads_.data(), left_sums_.data() + columns.left_px, right_sums_.data() + columns.right_px,
                    columns.count, test, candidates_.data());
    take_candidates(left, right, row_px, i, matches);
  }
}

void StripSearch::take_candidates(const GrayView& left, const GrayView& right, int row_px,
                                  std::size_t disparity, std::vector<BlockMatch>& matches) const {
  const auto& [columns, test, blocks] = searches_[disparity];
  const std::int64_t limit_units = rule_.disparities[disparity].limit_units;
  for (std::size_t word = 0; word < blocks.size(); ++word) {
    for (std::uint64_t bits = candidates_[word] & blocks[word]; bits != 0; bits &= bits - 1) {
      const std::size_t x = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
      const int left_px = columns.left_px + static_cast<int>(x),
                right_px = columns.right_px + static_cast<int>(x);
      const int left_edges = left_sums_[static_cast<std::size_t>(left_px)];
      const int right_edges = right_sums_[static_cast<std::size_t>(right_px)];
      int sad = sads_[x];
      if (std::count(&column_sads_[x], &column_sads_[x] + block_px, 255) > 0)
        sad = block_sad(left.row(row_px) + left_px, left.stride, right.row(row_px) + right_px, right.stride);
      if (scores_below(sad, left_edges + right_edges, limit_units))
        matches.push_back({left_px, row_px, static_cast<int>(disparity), sad, left_edges, right_edges});
    }
  }
}

PushbroomKernel::PushbroomKernel(const BlockRule& rule)
    : rule_(sound(rule)), strips_(rule_), self_similarity_(rule.window, rule.infinity_px) {
  for (const DisparityRule& one : rule.disparities)
    uniqueness_.emplace_back(one.disparity_px, std::min(one.disparity_px, rule.minimum_disparity_px),
                             std::max(one.disparity_px, rule.maximum_disparity_px), rule.uniqueness_ratio);
  if (rule.horizontal_invariance) right_edges_ = EdgeMap(rule.width_px, rule.height_px);
}

int PushbroomKernel::strip_count() const { return (row_count(rule_) - 1) / rule_.stride_px + 1; }

const std::vector<BlockMatch>& PushbroomKernel::search(const GrayView& left, const GrayView& right,
                                                       int first_strip, int last_strip, bool from_afar) {
  matches_.clear();
  if (first_strip >= last_strip) return matches_;
  const int first_row = first_strip * rule_.stride_px, last_row = (last_strip - 1) * rule_.stride_px;
  for (int row = first_row; row <= last_row; row += rule_.stride_px)
    strips_.search(left, right, row, from_afar, rule_.horizontal_invariance ? &right_edges_ : nullptr,
                   matches_);
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
