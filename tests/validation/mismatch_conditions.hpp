#pragma once

#include <string>
#include <vector>

#include "sim/aircraft/aircraft_config.hpp"

namespace understory {

/// One aircraft that differs from the stack's model.
struct MismatchCondition {
  std::string what;    ///< the curve it lies on; empty: the model itself
  double percent = 0;  ///< of the curve
  MismatchConfig mismatch;
  std::string name() const;
};

/// Every property adverse at once: `percent` heavier and more drag, less lift and less damping, and the delay
/// longer by five times as many percent.
MismatchConfig adverse(double percent);

/// The name of the curve on which everything is adverse at once.
inline constexpr const char* adverse_name = "all adverse";

/// What the page flies, the model itself first, then by curve.
std::vector<MismatchCondition> mismatch_conditions();

}  // namespace understory
