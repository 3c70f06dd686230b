#pragma once

#include "scenarios/validation/flight_record.hpp"
#include "scenarios/validation/section.hpp"

namespace understory {

/// The real jog's path flown by the path follower.
Section tracking_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);

}  // namespace understory
