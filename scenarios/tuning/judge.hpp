#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/scenario/scenario.hpp"
#include "scenarios/tuning/objective.hpp"

namespace understory {

/// What is counted on one unit of data (a flight, a recording), in the judge's own order. Counts of several
/// units together say what the configuration is on all of them.
using Counts = std::vector<double>;

struct Measured {
  std::vector<Counts> units;  ///< in the data's order, the same units for every scenario
  std::string refused;        ///< why nothing was measured, one line; empty where it was
};

/// Somebody asked the program to stop while something was being measured.
struct Stopped {};

/// Measures scenarios on some data. The same scenario comes out the same every time.
class Judge {
 public:
  virtual ~Judge() = default;
  /// `name`: letters, digits and '-', of this scenario alone. Throws Stopped, and MachineError where the
  /// machine fails.
  virtual Measured measure(const std::string& name, const Scenario& scenario) = 0;
  /// Of some units (one or more, some perhaps twice) together, in the order of the figures' names.
  virtual Figures figures(std::span<const Counts> units) const = 0;
};

}  // namespace understory
