#include "perception/rectification/byte_remap.hpp"

#include <algorithm>
#include <array>

#include "perception/assertion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perception/rectification/byte_remap.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Half = hn::FixedTag<std::uint8_t, ByteRemap::half_px>;

// A chunk's indices say for each pixel which byte of its half's first load it is, or, plus 128, of the
// second. A shuffle of bytes gives 0 for 128 and more.
template <class D, class V>
HWY_INLINE V FromSecond(D d, V indices) {
  return hn::Xor(indices, hn::Set(d, ByteRemap::second_load));
}

#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
using Chunk = hn::FixedTag<std::uint8_t, ByteRemap::chunk_px>;

// What two loads hold, side by side in one register.
HWY_INLINE hn::Vec<Chunk> Loaded(const std::uint8_t* source, const std::int32_t* offsets) {
  const Half half;
  return hn::Combine(Chunk(), hn::LoadU(half, source + offsets[1]), hn::LoadU(half, source + offsets[0]));
}

HWY_INLINE void RemapChunk(const std::uint8_t* source, const std::int32_t* offsets,
                           const std::uint8_t* indices, std::uint8_t* output) {
  const Chunk d;
  const auto places = hn::LoadU(d, indices);
  hn::StoreU(hn::Or(hn::TableLookupBytesOr0(Loaded(source, offsets), places),
                    hn::TableLookupBytesOr0(Loaded(source, offsets + 2), FromSecond(d, places))),
             d, output);
}
#else
HWY_INLINE void RemapChunk(const std::uint8_t* source, const std::int32_t* offsets,
                           const std::uint8_t* indices, std::uint8_t* output) {
  const Half d;
  for (int half = 0; half < 2; ++half) {
    const auto places = hn::LoadU(d, indices + ByteRemap::half_px * half);
    const auto first = hn::LoadU(d, source + offsets[half]),
               second = hn::LoadU(d, source + offsets[2 + half]);
    hn::StoreU(hn::Or(hn::TableLookupBytesOr0(first, places),
                      hn::TableLookupBytesOr0(second, FromSecond(d, places))),
               d, output + ByteRemap::half_px * half);
  }
}
#endif

void RemapRows(const ByteRemap::Tables& tables, const GrayView& source, int first_row_px, int last_row_px,
               std::uint8_t* output, std::ptrdiff_t output_stride) {
  const Half half;
  constexpr int px = ByteRemap::chunk_px, loads = ByteRemap::chunk_loads;
  const int chunks = tables.chunks, last_px = tables.last_column_px - px;
  // Copies: for all the compiler knows, the bytes written might be those of `source` and `tables`.
  const std::uint8_t* const pixels = source.data;
  const std::int32_t* offsets = tables.offsets.data() + std::ptrdiff_t{first_row_px} * chunks * loads;
  const std::uint8_t* indices = tables.indices.data() + std::ptrdiff_t{first_row_px} * chunks * px;
  // The map's own bend, and as long as memory takes to answer. What lies beyond the image is only asked for.
  const std::ptrdiff_t ahead = 12 * source.stride;
  for (int v = first_row_px; v < last_row_px; ++v) {
    std::uint8_t* row = output + v * output_stride + tables.first_column_px;
    for (int i = 1; i < chunks; ++i, offsets += loads, indices += px, row += px) {
      __builtin_prefetch(pixels + *offsets + ahead, 0, 1);
      RemapChunk(pixels, offsets, indices, row);
    }
    RemapChunk(pixels, offsets, indices, output + v * output_stride + last_px);
    offsets += loads, indices += px;
  }
  // All rows' in one loop: how many a row lacks could not be foreseen.
  const auto more_begin = static_cast<std::size_t>(tables.more_ends[static_cast<std::size_t>(first_row_px)]),
             more_end = static_cast<std::size_t>(tables.more_ends[static_cast<std::size_t>(last_row_px)]);
  for (std::size_t i = more_begin; i < more_end; ++i) {
    std::uint8_t* lacking = output + tables.more_rows[i] * output_stride + tables.more_columns[i];
    const auto places = hn::LoadU(half, tables.more_indices.data() + ByteRemap::half_px * i);
    const auto found = hn::TableLookupBytesOr0(hn::LoadU(half, pixels + tables.more_offsets[i]), places);
    const auto kept = hn::Eq(places, hn::Set(half, ByteRemap::as_it_is));
    hn::StoreU(hn::IfThenElse(kept, hn::LoadU(half, lacking), found), half, lacking);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(RemapRows);

}  // namespace

ByteRemap::ByteRemap(const std::vector<std::int16_t>& places, int width_px, int height_px,
                     int first_column_px, int last_column_px)
    : width_px_(width_px), height_px_(height_px) {
  assert_always(width_px >= chunk_px && height_px > 0, "images must be at least a chunk wide");
  assert_always(places.size() == 2 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                "a place is needed for each pixel");
  assert_always(0 <= first_column_px && first_column_px < last_column_px && last_column_px <= width_px,
                "columns outside the image");
  tables_.last_column_px = std::max(last_column_px, chunk_px);
  tables_.first_column_px = std::min(first_column_px, tables_.last_column_px - chunk_px);
  tables_.chunks = (tables_.last_column_px - tables_.first_column_px + chunk_px - 1) / chunk_px;
  tables_.more_ends.push_back(0);
  for (int v = 0; v < height_px; ++v) {
    for (int i = 0; i < tables_.chunks; ++i) {
      const int first = std::min(tables_.first_column_px + i * chunk_px, tables_.last_column_px - chunk_px);
      // Loads of nothing, from where the chunk before had its own, until its halves say what they need.
      loads_.resize(loads_.size() + chunk_loads, loads_.empty() ? Load() : loads_.back());
      tables_.indices.resize(tables_.indices.size() + chunk_px);
      for (int half = 0; half < 2; ++half) {
        const int first_px = first + half * half_px;
        add_half(places.data() + 2 * (v * width_px + first_px), first_px, v, half);
      }
    }
    tables_.more_ends.push_back(static_cast<std::int32_t>(more_.size()));
  }
}

void ByteRemap::add_half(const std::int16_t* places, int first_px, int row_px, int half) {
  std::array<bool, half_px> done{};
  const auto place = [&](int pixel) { return Load{places[2 * pixel], places[2 * pixel + 1]}; };
  const auto inside = [&](const Load& at) {
    return at.column_px >= 0 && at.column_px < width_px_ && at.row_px >= 0 && at.row_px < height_px_;
  };
  const auto more = [&](const Load& load) {
    more_.push_back(load);
    tables_.more_columns.push_back(first_px);
    tables_.more_rows.push_back(row_px);
    tables_.more_indices.resize(tables_.more_indices.size() + half_px, as_it_is);
    return &tables_.more_indices[tables_.more_indices.size() - half_px];
  };
  int loads = 0;
  bool some_outside = false;
  for (int i = 0; i < half_px; ++i) {
    const Load wanted = place(i);
    if (!inside(wanted)) {
      some_outside = true;
      continue;
    }
    if (done[static_cast<std::size_t>(i)]) continue;
    // The load begins with the leftmost pixel still wanted from this row that it can hold together with i.
    Load load{wanted.column_px, wanted.row_px};
    for (int j = i + 1; j < half_px; ++j) {
      const Load other = place(j);
      if (other.row_px == load.row_px && other.column_px >= 0 && other.column_px > wanted.column_px - half_px)
        load.column_px = std::min(load.column_px, other.column_px);
    }
    load.column_px = std::min(load.column_px, width_px_ - half_px);
    std::uint8_t* indices = nullptr;
    if (loads < chunk_loads / 2) {
      loads_[loads_.size() - chunk_loads + static_cast<std::size_t>(2 * loads + half)] = load;
      indices =
          &tables_.indices[tables_.indices.size() - chunk_px + static_cast<std::size_t>(half * half_px)];
    } else {
      indices = more(load);
    }
    for (int j = 0; j < half_px; ++j) {
      const Load other = place(j);
      const int within = other.column_px - load.column_px;
      const bool here = !done[static_cast<std::size_t>(j)] && other.row_px == load.row_px && within >= 0 &&
                        within < half_px && other.column_px < width_px_;
      if (!here) continue;
      indices[j] = static_cast<std::uint8_t>(loads == 1 ? second_load + within : within);
      done[static_cast<std::size_t>(j)] = true;
    }
    ++loads;
  }
  if (!some_outside) return;
  std::uint8_t* const indices = more(Load());
  for (int i = 0; i < half_px; ++i)
    if (!inside(place(i))) indices[i] = second_load;  // of a single load: nothing
}

void ByteRemap::prepare(std::ptrdiff_t stride) {
  if (stride == stride_) return;
  stride_ = stride;
  const auto take_offsets = [stride](const std::vector<Load>& loads, std::vector<std::int32_t>& offsets) {
    offsets.clear();
    for (const Load& load : loads)
      offsets.push_back(static_cast<std::int32_t>(load.row_px * stride + load.column_px));
  };
  take_offsets(loads_, tables_.offsets);
  take_offsets(more_, tables_.more_offsets);
}

void ByteRemap::apply(const GrayView& source, int first_row_px, int last_row_px, std::uint8_t* output,
                      std::ptrdiff_t output_stride) const {
  assert_always(source.width_px == width_px_ && source.height_px == height_px_,
                "another size than the map's");
  assert_always(source.stride == stride_, "prepare() was not called for this stride");
  assert_always(first_row_px >= 0 && last_row_px <= height_px_, "rows outside the image");
  HWY_DYNAMIC_DISPATCH(RemapRows)(tables_, source, first_row_px, last_row_px, output, output_stride);
}

}  // namespace understory
#endif  // HWY_ONCE
