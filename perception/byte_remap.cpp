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

// One row of chunks, the last of which ends with the row. Returns the number of loads made.
const std::int32_t* RemapRow(const std::uint8_t* source, const std::int32_t* offsets,
                             const std::int32_t* all_offsets, const std::uint8_t* indices,
                             const std::int32_t* ends, int width_px, std::uint8_t* output) {
  const hn::Full128<std::uint8_t> d;
  for (int u = 0; u < width_px; u += ByteRemap::chunk_px) {
    const std::int32_t* end = all_offsets + *ends++;
    auto pixels = hn::Zero(d);
    for (; offsets != end; ++offsets, indices += ByteRemap::chunk_px)
      pixels =
          hn::Or(pixels, hn::TableLookupBytesOr0(hn::LoadU(d, source + *offsets), hn::LoadU(d, indices)));
    hn::StoreU(pixels, d, output + std::min(u, width_px - ByteRemap::chunk_px));
  }
  return offsets;
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {
namespace {

HWY_EXPORT(RemapRow);

constexpr std::uint8_t none = 0x80;  // an index that gives 0

}  // namespace

ByteRemap::ByteRemap(const std::vector<std::int16_t>& places, int width_px, int height_px)
    : width_px_(width_px), height_px_(height_px) {
  assert_always(width_px >= chunk_px && height_px > 0, "images must be at least sixteen pixels wide");
  assert_always(places.size() == 2 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                "a place is needed for each pixel");
  for (int v = 0; v < height_px; ++v)
    for (int chunk = 0; chunk < width_px; chunk += chunk_px) {
      const int first = std::min(chunk, width_px - chunk_px);
      std::array<bool, chunk_px> done{};
      for (int i = 0; i < chunk_px; ++i) {
        const auto place = [&](int pixel) {
          const std::int16_t* at = places.data() + 2 * (v * width_px + first + pixel);
          return Load{at[0], at[1]};
        };
        const Load wanted = place(i);
        const bool inside = wanted.column_px >= 0 && wanted.column_px < width_px && wanted.row_px >= 0 &&
                            wanted.row_px < height_px;
        if (done[static_cast<std::size_t>(i)] || !inside) continue;
        // The load begins with the leftmost pixel still wanted from this row that it can hold together with
        // i.
        Load load{wanted.column_px, wanted.row_px};
        for (int j = i + 1; j < chunk_px; ++j) {
          const Load other = place(j);
          if (other.row_px == load.row_px && other.column_px >= 0 &&
              other.column_px > wanted.column_px - chunk_px)
            load.column_px = std::min(load.column_px, other.column_px);
        }
        load.column_px = std::min(load.column_px, width_px - chunk_px);
        loads_.push_back(load);
        for (int j = 0; j < chunk_px; ++j) {
          const Load other = place(j);
          const int within = other.column_px - load.column_px;
          const bool here = !done[static_cast<std::size_t>(j)] && other.row_px == load.row_px &&
                            within >= 0 && within < chunk_px && other.column_px < width_px;
          indices_.push_back(here ? static_cast<std::uint8_t>(within) : none);
          if (here) done[static_cast<std::size_t>(j)] = true;
        }
      }
      ends_.push_back(static_cast<std::int32_t>(loads_.size()));
    }
}

void ByteRemap::prepare(std::ptrdiff_t stride) {
  if (stride == stride_) return;
  stride_ = stride;
  offsets_.clear();
  for (const Load& load : loads_)
    offsets_.push_back(static_cast<std::int32_t>(load.row_px * stride + load.column_px));
}

void ByteRemap::apply(const GrayView& source, int first_row_px, int last_row_px, std::uint8_t* output,
                      std::ptrdiff_t output_stride) const {
  assert_always(source.width_px == width_px_ && source.height_px == height_px_,
                "another size than the map's");
  assert_always(source.stride == stride_, "prepare() was not called for this stride");
  assert_always(first_row_px >= 0 && last_row_px <= height_px_, "rows outside the image");
  const int chunks = (width_px_ + chunk_px - 1) / chunk_px;
  const std::size_t first_chunk = static_cast<std::size_t>(first_row_px) * static_cast<std::size_t>(chunks);
  const std::int32_t* offsets = offsets_.data() + (first_chunk == 0 ? 0 : ends_[first_chunk - 1]);
  for (int v = first_row_px; v < last_row_px; ++v) {
    constexpr int ahead = 12;  // rows: the map's own bend, and as long as memory takes to answer
    if (offsets != offsets_.data() + offsets_.size())
      source.prefetch(static_cast<int>(*offsets / stride_) + ahead, 1);
    offsets = HWY_DYNAMIC_DISPATCH(RemapRow)(
        source.data, offsets, offsets_.data(), indices_.data() + chunk_px * (offsets - offsets_.data()),
        ends_.data() + v * chunks, width_px_, output + v * output_stride);
  }
}

}  // namespace understory
#endif  // HWY_ONCE
