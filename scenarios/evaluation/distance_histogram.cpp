#include "scenarios/evaluation/distance_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace understory {

void DistanceHistogram::add(double distance_m) {
  if (!std::isfinite(distance_m)) {
    ++no_match;
    return;
  }
  const double bin = std::ceil(distance_m / bin_m) - 1;
  ++bins[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bin_count - 1)))];
}

void DistanceHistogram::add(const DistanceHistogram& other) {
  for (std::size_t i = 0; i < bin_count; ++i) bins[i] += other.bins[i];
  no_match += other.no_match;
}

std::int64_t DistanceHistogram::total() const { return std::accumulate(bins.begin(), bins.end(), no_match); }

double DistanceHistogram::share_within(double limit_m) const {
  const auto within = std::min<std::ptrdiff_t>(std::lround(limit_m / bin_m), bin_count);
  const std::int64_t count = std::accumulate(bins.begin(), bins.begin() + within, std::int64_t{0});
  return total() > 0 ? static_cast<double>(count) / static_cast<double>(total()) : 0;
}

double DistanceHistogram::share_without_match() const {
  return total() > 0 ? static_cast<double>(no_match) / static_cast<double>(total()) : 0;
}

}  // namespace understory
