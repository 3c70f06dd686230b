#pragma once

namespace understory {

/// What the autopilot commands. Elevons: positive trailing edge UP (as in the flight records), so equal
/// positive deflections pitch the nose up, and left above right rolls to the left.
struct Controls {
  double left_elevon_rad = 0;
  double right_elevon_rad = 0;
  double thrust_n = 0;  ///< along body x, 0 .. the airframe's maximum
};

}  // namespace understory
