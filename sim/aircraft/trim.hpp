#pragma once

#include <optional>

#include "planning/airframe.hpp"

namespace understory {

/// Straight steady flight with the wings level.
struct Trim {
  double airspeed_mps = 0;
  double climb_angle_rad = 0;
  double angle_of_attack_rad = 0;
  double elevon_rad = 0;  ///< both, positive trailing edge up
  double thrust_n = 0;
};

/// Newton's method on the three longitudinal equations of the flat-plate model. Empty where the airframe
/// cannot fly like this: thrust or elevons beyond their limits, or an angle of attack above
/// `max_angle_of_attack_rad` (flat plates never stall, real wings do at 25 to 30 deg).
std::optional<Trim> straight_trim(const Airframe& airframe, double airspeed_mps, double climb_angle_rad = 0,
                                  double max_angle_of_attack_rad = 0.5236);

}  // namespace understory
