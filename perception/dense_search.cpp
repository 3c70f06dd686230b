#include "perception/dense_search.hpp"

#include <algorithm>
#include <bit>

namespace understory {
namespace {

constexpr int ring_rows = block_px + 1;  // a window's rows and the one that comes in

// A window in one word: SAD, left and right edge sum (below 2^13 each) and its row and column in the cell.
// Edges of 0 lose against every window.
std::uint64_t packed(std::uint64_t sad, std::uint64_t left_edges, std::uint64_t right_edges,
                     std::uint64_t row, std::uint64_t column) {
  return sad | left_edges << 16 | right_edges << 32 | row << 48 | column << 56;
}
std::uint32_t sad_of(std::uint64_t window) { return window & 0xFFFF; }
std::uint32_t left_edges_of(std::uint64_t window) { return window >> 16 & 0xFFFF; }
std::uint32_t right_edges_of(std::uint64_t window) { return window >> 32 & 0xFFFF; }
constexpr std::uint64_t no_window = 1;

}  // namespace

DenseSearch::DenseSearch(const BlockRule& rule)
    : rule_(rule),
      edge_columns_(edge_columns(rule)),
      left_edges_(rule.width_px, ring_rows),
      left_running_(rule.width_px),
      right_running_(rule.width_px) {
  for (const DisparityRule& one : rule.disparities) {
    const SearchColumns columns = search_columns(rule, one);
    searches_.push_back({columns, candidate_test(one.least_edge_sum, one.limit_units),
                         RunningSums(columns.count), EdgeMap(columns.count, ring_rows),
                         std::vector<std::uint64_t>(static_cast<std::size_t>(columns.count / block_px + 1))});
  }
  const auto padded = static_cast<std::size_t>(rule.width_px + 2 * over_read_px);
  for (auto* sums : {&left_sums_, &right_sums_, &sads_}) sums->resize(padded);
  candidates_.resize(padded / 64 + 1);
}

void DenseSearch::search(const GrayView& left, const GrayView& right, int first_row_px, int last_row_px,
                         EdgeMap& right_edges, std::vector<BlockMatch>& matches) {
  const EdgeColumns& edges = edge_columns_;
  left_running_.clear();
  right_running_.clear();
  for (Search& search : searches_) search.sums.clear();
  for (int v = first_row_px; v + 1 < first_row_px + block_px; ++v)
    take_row_in(left, right, v, true, right_edges);
  for (int row = first_row_px; row < last_row_px; ++row) {
    if ((row - first_row_px) % block_px == 0)
      for (Search& search : searches_) std::fill(search.best.begin(), search.best.end(), no_window);
    take_row_in(left, right, row + block_px - 1, row == first_row_px, right_edges);
    left_running_.window_sums(rule_.width_px - edges.left_first_px, left_sums_.data() + edges.left_first_px);
    right_running_.window_sums(edges.right_last_px - edges.right_first_px,
                               right_sums_.data() + edges.right_first_px);
    for (std::size_t i = 0; i < searches_.size(); ++i) take_candidates(row, i);
    if ((row - first_row_px) % block_px == block_px - 1 || row + 1 == last_row_px)
      take_best(row - row % block_px, matches);
  }
}

void DenseSearch::take_row_in(const GrayView& left, const GrayView& right, int row_px, bool is_first_window,
                              EdgeMap& right_edges) {
  const EdgeColumns& edges = edge_columns_;
  const StripRows left_rows = left_reader_.rows(left, row_px), right_rows = right_reader_.rows(right, row_px);
  edge_row(left_rows.row[0], left_rows.row[1], left_rows.row[2], edges.left_first_px, rule_.width_px,
           rule_.width_px, left_edges_.row(row_px % ring_rows));
  edge_row(right_rows.row[0], right_rows.row[1], right_rows.row[2], edges.right_first_px, edges.right_last_px,
           rule_.width_px, right_edges.row(row_px));
  const auto move = [&](RunningSums& sums, EdgeMap& rows, int modulus, int first_px, int count) {
    const std::uint8_t* removed =
        is_first_window ? nullptr : rows.row((row_px - block_px) % modulus) + first_px;
    sums.move(rows.row(row_px % modulus) + first_px, removed, count);
  };
  move(left_running_, left_edges_, ring_rows, edges.left_first_px, rule_.width_px - edges.left_first_px);
  move(right_running_, right_edges, rule_.height_px, edges.right_first_px,
       edges.right_last_px - edges.right_first_px);
  for (Search& search : searches_) {
    difference_row(left_rows.row[1] + search.columns.left_px, right_rows.row[1] + search.columns.right_px,
                   search.columns.count, search.differences.row(row_px % ring_rows));
    move(search.sums, search.differences, ring_rows, 0, search.columns.count);
  }
}

// Windows that match lie together and their scores come in any order, so branches on them would be guessed
// wrong half the time: the better of two is picked without one. Whether the best really passes is asked once,
// in take_best: where it does not, none of its cell does.
void DenseSearch::take_candidates(int row_px, std::size_t disparity) {
  Search& search = searches_[disparity];
  const auto& [left_px, right_px, count] = search.columns;
  search.sums.window_sums(count, sads_.data());
  find_candidates(sads_.data(), left_sums_.data() + left_px, right_sums_.data() + right_px, count,
                  search.test, candidates_.data());
  for (int first = 0; first + block_px <= count; first += 64) {
    std::uint64_t bits = candidates_[static_cast<std::size_t>(first) / 64];
    if (first + 64 + block_px > count) bits &= (std::uint64_t{2} << (count - block_px - first)) - 1;
    for (; bits != 0; bits &= bits - 1) {
      const int x = first + std::countr_zero(bits), cell = x / block_px;
      const std::uint32_t sad = sads_[static_cast<std::size_t>(x)];
      const std::uint32_t left = left_sums_[static_cast<std::size_t>(left_px + x)];
      const std::uint32_t right = right_sums_[static_cast<std::size_t>(right_px + x)];
      std::uint64_t& best = search.best[static_cast<std::size_t>(cell)];
      // Both products stay below 2^27.
      const bool better = sad * (left_edges_of(best) + right_edges_of(best)) < sad_of(best) * (left + right);
      const std::uint64_t window = packed(sad, left, right, static_cast<std::uint64_t>(row_px % block_px),
                                          static_cast<std::uint64_t>(x - block_px * cell));
      best ^= (best ^ window) & (std::uint64_t{0} - std::uint64_t{better});
    }
  }
}

void DenseSearch::take_best(int first_row_px, std::vector<BlockMatch>& matches) {
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    const Search& search = searches_[i];
    for (std::size_t cell = 0; cell < search.best.size(); ++cell) {
      const std::uint64_t best = search.best[cell];
      const int sad = static_cast<int>(sad_of(best)), left_edges = static_cast<int>(left_edges_of(best)),
                right_edges = static_cast<int>(right_edges_of(best));
      if (!scores_below(sad, left_edges + right_edges, rule_.disparities[i].limit_units)) continue;
      const int column_px =
          search.columns.left_px + block_px * static_cast<int>(cell) + static_cast<int>(best >> 56);
      matches.push_back({column_px, first_row_px + static_cast<int>(best >> 48 & 0xFF), static_cast<int>(i),
                         sad, left_edges, right_edges});
    }
  }
}

}  // namespace understory
