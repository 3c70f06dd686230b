#pragma once

#include "planning/airframe.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// Straight flight without thrust: sink over speed.
Section glide_section(const Airframe& airframe);

}  // namespace understory
