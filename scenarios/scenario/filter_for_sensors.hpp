#pragma once

#include "estimation/filter_config.hpp"
#include "sim/sensors/sensors_config.hpp"

namespace understory {

/// `filter`, whose numbers hold for sensors of the nominal grade, adapted to the errors of `sensors`: noises,
/// biases, scale errors, vibration, and the barometer's error in the propeller's suction. Nominal sensors
/// change nothing.
FilterConfig filter_for_sensors(FilterConfig filter, const SensorsConfig& sensors);

}  // namespace understory
