#pragma once

namespace understory {

struct Interval {
  double minimum = 0;
  double maximum = 1;
};

/// The normal quantile of 95 % intervals: what every interval of this folder has unless it says otherwise.
inline constexpr double z_95 = 1.959963984540054;

}  // namespace understory
