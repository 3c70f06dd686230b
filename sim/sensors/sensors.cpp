#include "sim/sensors/sensors.hpp"

#include "sim/scene/world.hpp"

namespace understory {

bool divides_physics_rate(int rate_hz) { return rate_hz > 0 && physics_rate_hz % rate_hz == 0; }

}  // namespace understory
