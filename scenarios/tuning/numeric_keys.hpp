#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// One number of a scenario, with the bounds that its key has.
struct NumericKey {
  std::string key;     ///< "perception.pushbroom.score_limit"; an entry of a list: "... .depths_m[0]"
  bool whole = false;  ///< a whole number
  double minimum = 0, maximum = 0;
  double value = 0;  ///< in this scenario
};

/// Every number of a scenario in the order of its keys, seeds apart: a seed is nothing to be good at. Entries
/// of lists are there as far as the scenario has them.
std::vector<NumericKey> numeric_keys(Scenario scenario);

}  // namespace understory
