#pragma once

#include "planning/airframe.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// Straight flight with the wings level over speed: level as far as the motor carries it, descending beyond.
Section trim_section(const Airframe& airframe);

}  // namespace understory
