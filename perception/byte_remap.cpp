#include "perception/byte_remap.hpp"

#include <algorithm>
#include <array>

#include "perception/assertion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/byte_remap.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Of the source, what the load at an offset holds of a chunk.
template <class D>
hn::VFromD<D> Gathered(D d, const std::uint8_t* source, std::int32_t offset, const std::uint8_t* indices) {
  return hn::TableLookupBytesOr0(hn::LoadU(d, source + offset), hn::LoadU(d, indices));
}

// One row of chunks, two loads each, the last of which ends with the row.
void RemapRow(const std::uint8_t* source, const std::int32_t* offsets, const std::uint8_t* indices,
              int width_px, std::uint8_t* output) {
  const hn::Full128<std::uint8_t> d;
  constexpr int px = ByteRemap::chunk_px;
  for (int u = 0; u < width_px; u += px, offsets += 2, indices += 2 * px)
    hn::StoreU(
        hn::Or(Gathered(d, source, offsets[0], indices), Gathered(d, source, offsets[1], indices + px)), d,
        output + std::min(u, width_px - px));
}

// What a row's chunks still lack.
void AddLoads(const std::uint8_t* source, const std::int32_t* columns, const std::int32_t* offsets,
              const std::uint8_t* indices, int count, std::uint8_t* output) {
  const hn::Full128<std::uint8_t> d;
  for (int i = 0; i < count; ++i, indices += ByteRemap::chunk_px) {
    std::uint8_t* chunk = output + columns[i];
    hn::StoreU(hn::Or(hn::LoadU(d, chunk), Gathered(d, source, offsets[i], indices)), d, chunk);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(RemapRow);
HWY_EXPORT(AddLoads);

constexpr std::uint8_t none = 0x80;  // an index that gives 0

}  // namespace

ByteRemap::ByteRemap(const std::vector<std::int16_t>& places, int width_px, int height_px)
    : width_px_(width_px), height_px_(height_px) {
  assert_always(width_px >= chunk_px && height_px > 0, "images must be at least sixteen pixels wide");
  assert_always(places.size() == 2 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                "a place is needed for each pixel");
  for (int v = 0; v < height_px; ++v) {
    for (int chunk = 0; chunk < width_px; chunk += chunk_px) {
      const int first = std::min(chunk, width_px - chunk_px);
      add_chunk(places.data() + 2 * (v * width_px + first), first);
    }
    more_ends_.push_back(static_cast<std::int32_t>(more_.size()));
  }
}

void ByteRemap::add_chunk(const std::int16_t* places, int first_px) {
  std::array<bool, chunk_px> done{};
  const auto place = [&](int pixel) { return Load{places[2 * pixel], places[2 * pixel + 1]}; };
  int loads = 0;
  for (int i = 0; i < chunk_px; ++i) {
    const Load wanted = place(i);
    const bool inside = wanted.column_px >= 0 && wanted.column_px < width_px_ && wanted.row_px >= 0 &&
                        wanted.row_px < height_px_;
    if (done[static_cast<std::size_t>(i)] || !inside) continue;
    // The load begins with the leftmost pixel still wanted from this row that it can hold together with i.
    Load load{wanted.column_px, wanted.row_px};
    for (int j = i + 1; j < chunk_px; ++j) {
      const Load other = place(j);
      if (other.row_px == load.row_px && other.column_px >= 0 &&
          other.column_px > wanted.column_px - chunk_px)
        load.column_px = std::min(load.column_px, other.column_px);
    }
    load.column_px = std::min(load.column_px, width_px_ - chunk_px);
    const bool one_more = loads++ >= 2;
    if (one_more) more_columns_.push_back(first_px);
    (one_more ? more_ : loads_).push_back(load);
    for (int j = 0; j < chunk_px; ++j) {
      const Load other = place(j);
      const int within = other.column_px - load.column_px;
      const bool here = !done[static_cast<std::size_t>(j)] && other.row_px == load.row_px && within >= 0 &&
                        within < chunk_px && other.column_px < width_px_;
      (one_more ? more_indices_ : indices_).push_back(here ? static_cast<std::uint8_t>(within) : none);
      if (here) done[static_cast<std::size_t>(j)] = true;
    }
  }
  for (; loads < 2; ++loads) {  // a load of nothing, from where the one before was
    loads_.push_back(loads_.empty() ? Load() : loads_.back());
    indices_.insert(indices_.end(), chunk_px, none);
  }
}

void ByteRemap::prepare(std::ptrdiff_t stride) {
  if (stride == stride_) return;
  stride_ = stride;
  const auto take_offsets = [stride](const std::vector<Load>& loads, std::vector<std::int32_t>& offsets) {
    offsets.clear();
    for (const Load& load : loads)
      offsets.push_back(static_cast<std::int32_t>(load.row_px * stride + load.column_px));
  };
  take_offsets(loads_, offsets_);
  take_offsets(more_, more_offsets_);
}

void ByteRemap::apply(const GrayView& source, int first_row_px, int last_row_px, std::uint8_t* output,
                      std::ptrdiff_t output_stride) const {
  assert_always(source.width_px == width_px_ && source.height_px == height_px_,
                "another size than the map's");
  assert_always(source.stride == stride_, "prepare() was not called for this stride");
  assert_always(first_row_px >= 0 && last_row_px <= height_px_, "rows outside the image");
  const std::ptrdiff_t loads_per_row = 2 * ((width_px_ + chunk_px - 1) / chunk_px);
  for (int v = first_row_px; v < last_row_px; ++v) {
    constexpr int ahead = 12;  // rows: the map's own bend, and as long as memory takes to answer
    const std::int32_t* offsets = offsets_.data() + v * loads_per_row;
    source.prefetch(static_cast<int>(*offsets / stride_) + ahead, 1);
    std::uint8_t* row = output + v * output_stride;
    HWY_DYNAMIC_DISPATCH(RemapRow)
    (source.data, offsets, indices_.data() + chunk_px * v * loads_per_row, width_px_, row);
    const std::int32_t more = v == 0 ? 0 : more_ends_[static_cast<std::size_t>(v) - 1];
    HWY_DYNAMIC_DISPATCH(AddLoads)
    (source.data, more_columns_.data() + more, more_offsets_.data() + more,
     more_indices_.data() + chunk_px * more, more_ends_[static_cast<std::size_t>(v)] - more, row);
  }
}

}  // namespace understory
#endif  // HWY_ONCE
