#pragma once

#include "planning/airframe.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// How level flight, disturbed, comes back or runs away: eigenvalues over speed.
Section modes_section(const Airframe& airframe);

}  // namespace understory
