#pragma once

namespace understory {

/// What the mission asks for: fly along `heading_rad` until past the goal plane, inside the band and the
/// sides. Known before the flight, so it may be told to the stack. World frame of the estimator, origin at
/// the launch.
struct Mission {
  double heading_rad = 0;           ///< from world x towards world y
  double goal_distance_m = 75;      ///< of the goal plane, along the heading
  double half_width_m = 25;         ///< to each side
  double minimum_altitude_m = 1.0;  ///< in force once climbed
  double maximum_altitude_m = 6.0;
  double cruise_altitude_m = 4.5;
};

}  // namespace understory
