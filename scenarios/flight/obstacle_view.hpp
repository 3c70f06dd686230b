#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "scenarios/flight/flight_log.hpp"

namespace understory {

/// How many pixels of the left image show an obstacle from a pose, counted up to `enough`: rays through the
/// pixels' centres, the nearest obstacle counts. Nothing beyond the cameras' view distance is seen.
/// What a camera's cover hides at `t_ns` is not seen either.
int pixels_in_view(const FlightLog& log, std::int64_t t_ns, const Eigen::Isometry3d& T_world_body,
                   std::size_t obstacle, int enough);

}  // namespace understory
