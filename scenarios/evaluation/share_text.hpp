#pragma once

#include <fmt/format.h>

#include <string>

#include "scenarios/evaluation/share.hpp"
#include "scenarios/statistics/proportions.hpp"

namespace understory {

/// A share in a table's cell; "-" where nothing was counted.
inline std::string share_text(const Share& share) {
  return share.of > 0 ? fmt::format("{:.3f}", share.value()) : "-";
}

/// The same with its 95 % interval after Wilson.
inline std::string wilson_text(const Share& share) {
  if (share.of == 0) return "-";
  const Interval interval = wilson_interval(static_cast<int>(share.with), static_cast<int>(share.of));
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", share.value(), interval.minimum, interval.maximum);
}

}  // namespace understory
