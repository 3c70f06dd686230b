#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace understory {

/// Distances in the form of the paper's histograms (Barry & Tedrake 2015): bins of half a metre to 10 m,
/// everything farther in a last one, and those that had nothing to be compared with.
struct DistanceHistogram {
  static constexpr double bin_m = 0.5;
  static constexpr std::size_t bin_count = 21;
  std::array<std::int64_t, bin_count> bins{};  ///< a distance on an edge belongs to the nearer bin
  std::int64_t no_match = 0;

  /// Infinity is no match.
  void add(double distance_m);
  void add(const DistanceHistogram& other);
  std::int64_t total() const;  ///< no_match included
  /// Of all, no_match included, those within `limit_m`, a whole number of bins.
  double share_within(double limit_m) const;
  double share_without_match() const;
};

}  // namespace understory
