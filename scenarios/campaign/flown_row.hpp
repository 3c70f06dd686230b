#pragma once

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// The row of a flight that came to an ending. Sets everything but id and condition.
FlightRow flown_row(const Scenario& scenario, const FlightResult& result);

}  // namespace understory
