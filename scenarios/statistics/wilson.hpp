#pragma once

#include <cmath>

#include "scenarios/statistics/interval.hpp"

namespace understory {

/// Wilson's score interval for a proportion (Wilson 1927, J. Am. Stat. Assoc. 22), without continuity
/// correction. `z` is the normal quantile: 1.959964 for 95 %. No trials: 0 .. 1.
inline Interval wilson_interval(int successes, int trials, double z = z_95) {
  if (trials == 0) return {0, 1};
  const double n = trials;
  const double share = successes / n;
  const double scale = 1 / (1 + z * z / n);
  const double centre = scale * (share + z * z / (2 * n));
  const double half = scale * z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  return {centre - half, centre + half};
}

}  // namespace understory
