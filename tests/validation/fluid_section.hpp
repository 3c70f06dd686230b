#pragma once

#include "planning/airframe.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// The flat plates beside MuJoCo's own fluid on the same geometry, over angle of attack and sideslip.
Section fluid_section(const Airframe& airframe);

}  // namespace understory
