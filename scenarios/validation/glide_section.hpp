#pragma once

#include "planning/airframe.hpp"
#include "scenarios/validation/section.hpp"

namespace understory {

/// Straight flight without thrust: sink over speed.
Section glide_section(const Airframe& airframe);

}  // namespace understory
