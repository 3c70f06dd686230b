#include "sim/sensors.hpp"

#include "sim/world.hpp"

namespace understory {

bool divides_physics_rate(int rate_hz) { return rate_hz > 0 && physics_rate_hz % rate_hz == 0; }

}  // namespace understory
