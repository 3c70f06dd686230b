#include "perception/pushbroom/match_filters.hpp"

#include <cstring>

#include "perception/pushbroom/block_rule.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/pushbroom/self_similarity.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

#ifndef UNDERSTORY_SELF_SIMILARITY_ONCE
#define UNDERSTORY_SELF_SIMILARITY_ONCE
namespace understory {

// Up to eight neighbouring blocks are compared at once, each in a group of eight bytes of which five hold a
// row of the block.
inline constexpr int shift_count = 8;
inline constexpr int group_bytes = 8;
inline constexpr int load_bytes = 16;
inline constexpr std::uint64_t row_of_block = 0xFF'FFFF'FFFF;  // the five bytes of a group that hold it

// Byte indices that put the five bytes from g on into group g; 128 gives zero.
struct ShiftIndices {
  std::uint8_t shifted[shift_count * group_bytes];
  ShiftIndices() {
    for (int group = 0; group < shift_count; ++group)
      for (int i = 0; i < group_bytes; ++i) {
        const bool used = i < block_px;
        shifted[group * group_bytes + i] = used ? static_cast<std::uint8_t>(group + i) : 0x80;
      }
  }
};

using WindowTask = SelfSimilarityFilter::Task;

// What all tasks have in common.
struct WindowSearch {
  std::ptrdiff_t left_stride = 0, right_stride = 0, right_edges_stride = 0;
  SelfSimilarityWindow window;
};

}  // namespace understory
#endif

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Bytes = hn::CappedTag<std::uint8_t, shift_count * group_bytes>;
using Sums = hn::Repartition<std::uint64_t, Bytes>;

HWY_INLINE hn::Vec<Sums> SumsOfDifferences(hn::Vec<Bytes> a, hn::Vec<Bytes> b) {
  return hn::SumsOf8(hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a)));
}

// Whether a block of the window that begins at `row` is similar. No branch that depends on the images.
HWY_INLINE bool RowIsSimilar(const WindowSearch& search, const WindowTask& task, int row,
                             const ShiftIndices& indices) {
  const Bytes d;
  const Sums d64;
  const hn::Repartition<std::uint32_t, Bytes> d32;
  const hn::RebindToSigned<Sums> signed64;
  const int groups = static_cast<int>(hn::Lanes(d)) / group_bytes;
  const int shifts = 2 * search.window.columns_each_side_px + 1;
  const auto block_row = hn::BitCast(d, hn::Set(d64, row_of_block));
  const std::uint8_t* right = task.right + row * search.right_stride;
  const std::uint8_t* right_edges = task.right_edges + row * search.right_edges_stride;
  auto similar = hn::MaskFromVec(hn::Zero(signed64));
  for (int first = 0; first < shifts; first += groups) {
    const int column = first / shift_count * shift_count;
    const auto shifted = hn::LoadU(d, indices.shifted + (first - column) * group_bytes);
    auto sad = hn::Zero(d64), edges = hn::Zero(d64);
    for (int v = 0; v < block_px; ++v) {
      std::uint64_t group = 0;
      std::memcpy(&group, task.block + v * search.left_stride, group_bytes);
      const auto block = hn::And(hn::BitCast(d, hn::Set(d64, group)), block_row);
      const auto other =
          hn::TableLookupBytesOr0(hn::LoadDup128(d, right + v * search.right_stride + column), shifted);
      const auto other_edges = hn::TableLookupBytesOr0(
          hn::LoadDup128(d, right_edges + v * search.right_edges_stride + column), shifted);
      sad = hn::Add(sad, SumsOfDifferences(block, other));
      edges = hn::Add(edges, hn::SumsOf8(other_edges));
    }
    // SAD / (both edge sums) < limit, as in scores_below() (block_rule.hpp); 64 bits hold every product.
    const auto both_edges = hn::Add(edges, hn::Set(d64, static_cast<std::uint64_t>(task.left_edge_sum)));
    const auto scaled_sad =
        hn::MulEven(hn::BitCast(d32, sad), hn::Set(d32, static_cast<std::uint32_t>(score_unit)));
    const auto limit = hn::MulEven(hn::BitCast(d32, both_edges),
                                   hn::Set(d32, static_cast<std::uint32_t>(search.window.limit_units)));
    const auto scores = hn::Lt(hn::BitCast(signed64, scaled_sad), hn::BitCast(signed64, limit));
    const auto textured = hn::Gt(hn::BitCast(signed64, edges),
                                 hn::Set(signed64, std::int64_t{search.window.minimum_edge_sum} - 1));
    const auto inside = hn::FirstN(signed64, static_cast<std::size_t>(shifts - first));
    similar = hn::Or(similar, hn::And(hn::And(scores, textured), inside));
  }
  return !hn::AllFalse(signed64, similar);
}

// Keeps, in their order, the tasks without a similar block in the window's row `row`; says how many.
std::size_t DropSimilar(const WindowSearch& search, int row, const ShiftIndices& indices, WindowTask* tasks,
                        std::size_t count) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const WindowTask task = tasks[i];
    tasks[kept] = task;
    kept += RowIsSimilar(search, task, row, indices) ? 0 : 1;
  }
  return kept;
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(DropSimilar);

bool window_inside(const GrayView& image, int column_px, int row_px, const SelfSimilarityWindow& window) {
  return column_px - window.columns_each_side_px >= 0 && row_px - window.rows_each_side_px >= 0 &&
         column_px + window.columns_each_side_px + block_px <= image.width_px &&
         row_px + window.rows_each_side_px + block_px <= image.height_px;
}

bool similar_one_by_one(const WindowSearch& search, const WindowTask& task) {
  const SelfSimilarityWindow& window = search.window;
  for (int v = 0; v <= 2 * window.rows_each_side_px; v += window.row_step_px)
    for (int u = 0; u <= 2 * window.columns_each_side_px; ++u) {
      const int sad = block_sad(task.block, search.left_stride, task.right + v * search.right_stride + u,
                                search.right_stride);
      const int edges =
          block_sum(task.right_edges + v * search.right_edges_stride + u, search.right_edges_stride);
      if (edges >= window.minimum_edge_sum &&
          scores_below(sad, task.left_edge_sum + edges, window.limit_units))
        return true;
    }
  return false;
}

}  // namespace

SelfSimilarityFilter::SelfSimilarityFilter(const SelfSimilarityWindow& window, int infinity_px)
    : window_(window), infinity_px_(infinity_px) {}

void SelfSimilarityFilter::drop_similar(const GrayView& left, const GrayView& right,
                                        const GrayView& right_edges, std::vector<BlockMatch>& matches) {
  static const ShiftIndices indices;
  const WindowSearch search{left.stride, right.stride, right_edges.stride, window_};
  tasks_.resize(matches.size());
  unlike_.assign(matches.size(), 0);
  std::size_t count = 0;
  const int columns = window_.columns_each_side_px, rows = window_.rows_each_side_px;
  // Loads overshoot a row by less than load_bytes, which the rows that follow must hold.
  const int last_safe_row = right.height_px - rows - block_px - 1 - load_bytes / right.width_px;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const BlockMatch& match = matches[i];
    const int column_px = match.column_px - infinity_px_;
    if (!window_inside(right, column_px, match.row_px, window_)) continue;
    const std::ptrdiff_t first_column = column_px - columns, first_row = match.row_px - rows;
    WindowTask& task = tasks_[count];
    task = {left.row(match.row_px) + match.column_px, right.data + first_row * right.stride + first_column,
            right_edges.data + first_row * right_edges.stride + first_column, match.left_edge_sum,
            static_cast<int>(i)};
    if (match.row_px <= last_safe_row) {
      ++count;
    } else {
      unlike_[i] = !similar_one_by_one(search, task);
    }
  }
  // A row of the windows for all blocks, then the next: a block at a time, when it is found similar could not
  // be foreseen. What repeats usually does so near the block's own row: from the middle outwards.
  const int row_count = 2 * window_.rows_each_side_px / window_.row_step_px + 1, middle = row_count / 2;
  for (int i = 0; i < 2 * row_count && count > 0; ++i) {
    const int index = middle + (i % 2 == 0 ? i / 2 : -(i + 1) / 2);
    if (index < 0 || index >= row_count) continue;
    count =
        HWY_DYNAMIC_DISPATCH(DropSimilar)(search, index * window_.row_step_px, indices, tasks_.data(), count);
  }
  for (std::size_t i = 0; i < count; ++i) unlike_[static_cast<std::size_t>(tasks_[i].match)] = 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    matches[kept] = matches[i];
    kept += unlike_[i];
  }
  matches.resize(kept);
}

}  // namespace understory
#endif  // HWY_ONCE
