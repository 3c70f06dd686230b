#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace understory {

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

/// `bytes` up to whole lines.
constexpr int whole_lines(int bytes) { return (bytes + 63) / 64 * 64; }

}  // namespace understory
