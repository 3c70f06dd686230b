#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace understory {

/// An 8-bit gray image owned by somebody else: pointer and stride only, so that the detector's arithmetic
/// needs no image library and builds alone.
struct GrayView {
  const std::uint8_t* data = nullptr;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next
  int width_px = 0;
  int height_px = 0;

  const std::uint8_t* row(int row_px) const { return data + row_px * stride; }
  /// Prefetches the rows first_row_px .. first_row_px + count - 1 (those that exist) into the cache, long
  /// before they are read: a new picture from a camera is in no cache.
  void prefetch(int first_row_px, int count) const {
    const int last_row_px = first_row_px + count < height_px ? first_row_px + count : height_px;
    if (first_row_px >= last_row_px) return;
    const std::uint8_t* end = row(last_row_px - 1) + width_px;
    for (const std::uint8_t* line = row(first_row_px); line < end; line += 64) __builtin_prefetch(line);
  }
  /// Whether `count` bytes from (column, row) on lie inside the image's memory, following rows included, so
  /// that a vector load may read them.
  bool can_read(int column_px, int row_px, int count) const {
    return row_px * stride + column_px + count <= (height_px - 1) * stride + width_px;
  }
};

/// Memory that begins with a cache line, so that loads and stores of whole vectors at multiples of 64 bytes
/// touch one line each.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line_bytes{64};
  CacheLineAllocator() = default;
  template <class Other>
  CacheLineAllocator(const CacheLineAllocator<Other>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line_bytes)); }
  void deallocate(T* first, std::size_t) { ::operator delete(first, line_bytes); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// `bytes` rounded up to whole cache lines.
constexpr int whole_lines(int bytes) { return (bytes + 63) / 64 * 64; }

}  // namespace understory
