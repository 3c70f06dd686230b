#pragma once

#include <cstdint>

namespace understory {

/// A count out of a total.
struct Share {
  std::int64_t of = 0;
  std::int64_t with = 0;

  void count(bool has) {
    ++of;
    with += has;
  }
  void add(const Share& other) {
    of += other.of;
    with += other.with;
  }
  /// 0 .. 1; 0 of nothing.
  double value() const { return of > 0 ? static_cast<double>(with) / static_cast<double>(of) : 0; }
};

}  // namespace understory
