#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "scenarios/flight/flight_log.hpp"

namespace understory {

/// How many pixels of the left image show an obstacle from a pose, counted up to `enough`: rays through the
/// pixels' centres, the nearest obstacle counts. Nothing beyond the cameras' view distance is seen.
int pixels_in_view(const FlightLog& log, const Eigen::Isometry3d& T_world_body, std::size_t obstacle,
                   int enough);

}  // namespace understory
