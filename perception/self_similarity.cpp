#include "perception/self_similarity.hpp"

#include "perception/block_score.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/self_similarity.cpp"
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

// Byte indices that put the five bytes of a row into groups; 128 gives zero.
struct ShiftIndices {
  std::uint8_t same[shift_count * group_bytes];     // shift 0 in every group
  std::uint8_t shifted[shift_count * group_bytes];  // shift g in group g
  ShiftIndices() {
    for (int group = 0; group < shift_count; ++group)
      for (int i = 0; i < group_bytes; ++i) {
        const bool used = i < block_px;
        same[group * group_bytes + i] = used ? static_cast<std::uint8_t>(i) : 0x80;
        shifted[group * group_bytes + i] = used ? static_cast<std::uint8_t>(group + i) : 0x80;
      }
  }
};

struct WindowTask {
  const std::uint8_t* block = nullptr;  // the left block
  std::ptrdiff_t left_stride = 0;
  const std::uint8_t* right = nullptr;  // the right image, at the window's first column and row
  std::ptrdiff_t right_stride = 0;
  const std::uint8_t* right_edges = nullptr;  // its edge map, at the same place
  std::ptrdiff_t right_edges_stride = 0;
  int left_edge_sum = 0;
};

}  // namespace understory
#endif

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Bytes = hn::CappedTag<std::uint8_t, shift_count * group_bytes>;
using Sums = hn::Repartition<std::uint64_t, Bytes>;
using Halves = hn::Repartition<std::uint32_t, Bytes>;

HWY_INLINE hn::Vec<Sums> SumsOfDifferences(hn::Vec<Bytes> a, hn::Vec<Bytes> b) {
  return hn::SumsOf8(hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a)));
}

// Whether a block of the window that begins at `row` is similar.
HWY_INLINE bool RowIsSimilar(const WindowTask& task, const hn::Vec<Bytes>* block, int row,
                             const SelfSimilarityWindow& window, const ShiftIndices& indices) {
  const Bytes d;
  const Sums d64;
  const hn::Repartition<std::uint32_t, Bytes> d32;
  const hn::RebindToSigned<Sums> signed64;
  const int groups = static_cast<int>(hn::Lanes(d)) / group_bytes;
  const int shifts = 2 * window.columns_each_side_px + 1;
  for (int first = 0; first < shifts; first += groups) {
    const int column = first / shift_count * shift_count;
    const auto shifted = hn::LoadU(d, indices.shifted + (first - column) * group_bytes);
    auto sad = hn::Zero(d64), edges = hn::Zero(d64);
    for (int v = 0; v < block_px; ++v) {
      const auto other = hn::TableLookupBytesOr0(
          hn::LoadDup128(d, task.right + (row + v) * task.right_stride + column), shifted);
      const auto other_edges = hn::TableLookupBytesOr0(
          hn::LoadDup128(d, task.right_edges + (row + v) * task.right_edges_stride + column), shifted);
      sad = hn::Add(sad, SumsOfDifferences(block[v], other));
      edges = hn::Add(edges, hn::SumsOf8(other_edges));
    }
    // SAD / (both edge sums) < limit, as block_score.hpp has it; 64 bits hold every product.
    const auto both_edges = hn::Add(edges, hn::Set(d64, static_cast<std::uint64_t>(task.left_edge_sum)));
    const auto scaled_sad =
        hn::MulEven(hn::BitCast(d32, sad), hn::Set(d32, static_cast<std::uint32_t>(score_unit)));
    const auto limit = hn::MulEven(hn::BitCast(d32, both_edges),
                                   hn::Set(d32, static_cast<std::uint32_t>(window.limit_units)));
    const auto scores = hn::Lt(hn::BitCast(signed64, scaled_sad), hn::BitCast(signed64, limit));
    const auto textured =
        hn::Gt(hn::BitCast(signed64, edges), hn::Set(signed64, std::int64_t{window.least_edge_sum} - 1));
    const auto inside = hn::FirstN(signed64, static_cast<std::size_t>(shifts - first));
    if (!hn::AllFalse(signed64, hn::And(hn::And(scores, textured), inside))) return true;
  }
  return false;
}

bool WindowIsSimilar(const WindowTask& task, const SelfSimilarityWindow& window,
                     const ShiftIndices& indices) {
  const Bytes d;
  hn::Vec<Bytes> block[block_px];
  for (int v = 0; v < block_px; ++v)
    block[v] = hn::TableLookupBytesOr0(hn::LoadDup128(d, task.block + v * task.left_stride),
                                       hn::LoadU(d, indices.same));
  const int row_count = 2 * window.rows_each_side_px / window.row_step_px + 1;
  // What repeats usually does so near the block's own row: from the middle outwards.
  const int middle = row_count / 2;
  for (int i = 0; i < 2 * row_count; ++i) {
    const int index = middle + (i % 2 == 0 ? i / 2 : -(i + 1) / 2);
    if (index < 0 || index >= row_count) continue;
    if (RowIsSimilar(task, block, index * window.row_step_px, window, indices)) return true;
  }
  return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(WindowIsSimilar);

bool window_inside(const GrayView& image, int column_px, int row_px, const SelfSimilarityWindow& window) {
  return column_px - window.columns_each_side_px >= 0 && row_px - window.rows_each_side_px >= 0 &&
         column_px + window.columns_each_side_px + block_px <= image.width_px &&
         row_px + window.rows_each_side_px + block_px <= image.height_px;
}

bool similar_one_by_one(const WindowTask& task, const SelfSimilarityWindow& window) {
  for (int v = 0; v <= 2 * window.rows_each_side_px; v += window.row_step_px)
    for (int u = 0; u <= 2 * window.columns_each_side_px; ++u) {
      const int sad =
          block_sad(task.block, task.left_stride, task.right + v * task.right_stride + u, task.right_stride);
      const int edges =
          block_sum(task.right_edges + v * task.right_edges_stride + u, task.right_edges_stride);
      if (edges >= window.least_edge_sum && scores_below(sad, task.left_edge_sum + edges, window.limit_units))
        return true;
    }
  return false;
}

}  // namespace

bool self_similar(const GrayView& left, const GrayView& right, const GrayView& right_edges, int column_px,
                  int row_px, int infinity_column_px, int left_edge_sum, const SelfSimilarityWindow& window) {
  if (!window_inside(right, infinity_column_px, row_px, window)) return true;
  static const ShiftIndices indices;
  const int first_column = infinity_column_px - window.columns_each_side_px;
  const int first_row = row_px - window.rows_each_side_px;
  WindowTask task;
  task.block = left.row(row_px) + column_px;
  task.left_stride = left.stride;
  task.right = right.row(first_row) + first_column;
  task.right_stride = right.stride;
  task.right_edges = right_edges.row(first_row) + first_column;
  task.right_edges_stride = right_edges.stride;
  task.left_edge_sum = left_edge_sum;
  const int last_row = row_px + window.rows_each_side_px + block_px - 1;
  const int bytes = 2 * window.columns_each_side_px + load_bytes;
  if (!left.can_read(column_px, row_px + block_px - 1, load_bytes) ||
      !right.can_read(first_column, last_row, bytes) || !right_edges.can_read(first_column, last_row, bytes))
    return similar_one_by_one(task, window);
  return HWY_DYNAMIC_DISPATCH(WindowIsSimilar)(task, window, indices);
}

}  // namespace understory
#endif  // HWY_ONCE
