#include "perception/pushbroom/dense_search.hpp"

#include <algorithm>
#include <bit>

namespace understory {
namespace {

// A window in one word that is smaller the better the window is: its score as a double, whose last bits say
// where it lies in its cell, by row, then column. Scores of two windows are equal or differ by more than
// 2^-28 (their edges sum to less than 2^14), so those bits are free and the first of equals wins.
constexpr std::uint64_t place_bits = 0xFF, no_window = ~std::uint64_t{0};

std::uint64_t packed(int sad, int edges, int row, int column) {
  const auto score = std::bit_cast<std::uint64_t>(static_cast<double>(sad) / static_cast<double>(edges));
  return (score & ~place_bits) | static_cast<std::uint64_t>(row << 4 | column);
}
int row_of(std::uint64_t window) { return static_cast<int>(window >> 4 & 0xF); }
int column_of(std::uint64_t window) { return static_cast<int>(window & 0xF); }

void clear(EdgeMap& rows) {
  for (int v = 0; v < block_px; ++v) std::fill_n(rows.row(v), rows.stride(), std::uint8_t{0});
}

}  // namespace

DenseSearch::DenseSearch(const BlockRule& rule)
    : rule_(rule),
      edge_columns_(edge_columns(rule)),
      left_edges_(rule.width_px, block_px),
      left_running_(rule.width_px),
      right_running_(rule.width_px),
      nothing_(static_cast<std::size_t>(rule.width_px + over_read_px)),
      windows_(rule.width_px) {
  for (const DisparityRule& one : rule.disparities) {
    const SearchColumns columns = search_columns(rule, one);
    searches_.push_back({columns, candidate_test(one.minimum_edge_sum, one.limit_units),
                         RunningSums(columns.count), EdgeMap(columns.count, block_px),
                         std::vector<std::uint64_t>(static_cast<std::size_t>(columns.count / block_px + 1))});
  }
  cells_.resize(static_cast<std::size_t>(rule.width_px / block_px + 2));
}

void DenseSearch::search(const GrayView& left, const GrayView& right, int first_row_px, int last_row_px,
                         EdgeMap& right_edges, std::vector<BlockMatch>& matches) {
  left_running_.clear();
  right_running_.clear();
  clear(left_edges_);
  for (Search& search : searches_) {
    search.sums.clear();
    clear(search.differences);
  }
  take_rows_in(left, right, first_row_px, block_px - 1, first_row_px, right_edges);
  for (int row = first_row_px; row < last_row_px; row += block_px) {
    const int count = std::min(block_px, last_row_px - row);
    take_rows_in(left, right, row + block_px - 1, count, first_row_px, right_edges);
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      std::fill(searches_[i].best.begin(), searches_[i].best.end(), no_window);
      for (int v = 0; v < count; ++v) take_candidates(searches_[i], v);
      take_best(searches_[i], row, static_cast<int>(i), matches);
    }
  }
}

void DenseSearch::take_rows_in(const GrayView& left, const GrayView& right, int row_px, int count,
                               int first_row_px, EdgeMap& right_edges) {
  const StripRows left_rows = left_reader_.rows(left, row_px), right_rows = right_reader_.rows(right, row_px);
  const auto same_places = [&](EdgeMap& rows) {
    MovedRows moved{{}, {}, count};
    for (int v = 0; v < count; ++v) moved.removed[v] = moved.added[v] = rows.row((row_px + v) % block_px);
    return moved;
  };
  const EdgeColumns& edges = edge_columns_;
  left_running_.take_edges(left_rows, edges.left_first_px, rule_.width_px, rule_.width_px,
                           same_places(left_edges_));
  MovedRows moved{{}, {}, count};
  for (int v = 0; v < count; ++v) {
    const int removed_px = row_px + v - block_px;
    moved.added[v] = right_edges.row(row_px + v) + edges.right_first_px;
    moved.removed[v] =
        removed_px >= first_row_px ? right_edges.row(removed_px) + edges.right_first_px : nothing_.data();
  }
  right_running_.take_edges(right_rows, edges.right_first_px, edges.right_last_px, rule_.width_px, moved);
  for (Search& search : searches_)
    search.sums.take_differences(left_rows, search.columns.left_px, right_rows, search.columns.right_px,
                                 search.columns.count, same_places(search.differences));
}

ColumnSumRow DenseSearch::left_sums(const Search& search, int window_row) const {
  return from_column(left_running_.row(window_row), search.columns.left_px - edge_columns_.left_first_px);
}
ColumnSumRow DenseSearch::right_sums(const Search& search, int window_row) const {
  return from_column(right_running_.row(window_row), search.columns.right_px - edge_columns_.right_first_px);
}

// Windows that match lie together and their scores come in any order, so branches on them would be guessed
// wrong half the time. Whether the best really passes is asked once, in take_best: where it does not, none of
// its cell does.
void DenseSearch::take_candidates(Search& search, int window_row) {
  const int count = search.columns.count;
  const int candidates = test_windows(search.sums.row(window_row), left_sums(search, window_row),
                                      right_sums(search, window_row), count, search.test, windows_);
  const std::uint16_t* const sads[] = {windows_.sads[0].data(), windows_.sads[1].data()};
  const std::uint16_t* const edges[] = {windows_.edges[0].data(), windows_.edges[1].data()};
  std::uint64_t* const best = search.best.data();
  const std::uint16_t* const xs = windows_.candidates.data();
  for (int k = 0; k < candidates; ++k) {
    const unsigned x = xs[k], cell = x / block_px;
    best[cell] = std::min(best[cell], packed(sads[x % 2][x / 2], edges[x % 2][x / 2], window_row,
                                             static_cast<int>(x - block_px * cell)));
  }
}

void DenseSearch::take_best(const Search& search, int row_px, int disparity,
                            std::vector<BlockMatch>& matches) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < search.best.size(); ++cell) {
    cells_[count] = static_cast<int>(cell);
    count += search.best[cell] != no_window ? 1 : 0;
  }
  ColumnSumRow sads[block_px], lefts[block_px], rights[block_px];
  for (int v = 0; v < block_px; ++v) {
    sads[v] = search.sums.row(v);
    lefts[v] = left_sums(search, v);
    rights[v] = right_sums(search, v);
  }
  const std::int64_t limit_units = rule_.disparities[static_cast<std::size_t>(disparity)].limit_units;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t best = search.best[static_cast<std::size_t>(cells_[i])];
    const int window_row = row_of(best), x = block_px * cells_[i] + column_of(best);
    const int sad = window_sum(sads[window_row], x), left_edges = window_sum(lefts[window_row], x),
              right_edges = window_sum(rights[window_row], x);
    if (scores_below(sad, left_edges + right_edges, limit_units))
      matches.push_back(
          {search.columns.left_px + x, row_px + window_row, disparity, sad, left_edges, right_edges});
  }
}

}  // namespace understory
