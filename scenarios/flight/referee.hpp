#pragma once

#include <optional>

#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/aircraft.hpp"

namespace understory {

/// Decides, from the truth alone, when a flight is over and how it ended.
class Referee {
 public:
  explicit Referee(const Scenario& scenario) : scenario_(scenario) {}

  /// Once per physics step; a value ends the flight.
  std::optional<Outcome> outcome_at(const Truth& truth, Contact contact, bool released);

 private:
  Scenario scenario_;
  bool climbed_ = false;  ///< the band's lower limit is in force
};

}  // namespace understory
