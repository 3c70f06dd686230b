#pragma once

#include "tests/validation/flight_record.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// The real jog's path flown by the path follower.
Section tracking_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);

}  // namespace understory
