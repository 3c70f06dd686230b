#pragma once

#include "tests/validation/free_flight.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// The fastest roll that two elevons can make, over speed, flown in the simulator.
Section roll_section(const FreeFlight& air, const Airframe& airframe);

}  // namespace understory
