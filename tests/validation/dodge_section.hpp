#pragma once

#include "tests/validation/free_flight.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// How far aside within the distance that is seen, and what a jog costs.
Section dodge_section(const FreeFlight& air, const Airframe& airframe);

}  // namespace understory
