#pragma once

#include <cstdint>
#include <vector>

#include "perception/strip_sums.hpp"

/// The dense detector's inner loops: sums of the 5x5 windows at every pixel of a row, carried from row to
/// row, in portable SIMD. Exact. All rows have over_read_px spare columns behind their last.
namespace understory {

/// Sums of five rows in each column of a byte image, moved down row by row.
class RunningSums {
 public:
  /// For rows of up to `width` columns.
  explicit RunningSums(int width);
  void clear();
  /// Takes a row into the sums and, unless null, one out of them. Columns 0 .. count - 1.
  void move(const std::uint8_t* added, const std::uint8_t* removed, int count);
  /// sums[x] = the five columns from x on, for x <= count - 5.
  void window_sums(int count, std::uint16_t* sums) const;

 private:
  std::vector<std::uint16_t> even_, odd_;  ///< columns 2 i and 2 i + 1
};

/// out[x] = |left[x] - right[x]|
void difference_row(const std::uint8_t* left, const std::uint8_t* right, int count, std::uint8_t* out);

}  // namespace understory
