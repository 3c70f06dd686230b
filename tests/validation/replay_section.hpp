#pragma once

#include "tests/validation/flight_record.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// The real left jog's inputs flown open loop, with the identified parameters and with those that its first
/// half tells.
Section replay_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);

}  // namespace understory
