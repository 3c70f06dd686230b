#include "perception/pushbroom/strip_search.hpp"

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

}  // namespace understory
