#pragma once

#include "planning/airframe.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// Level turns over bank: radius, load factor, speed gained or lost with all the thrust; the bank that holds
/// its speed.
Section turn_section(const Airframe& airframe);

}  // namespace understory
