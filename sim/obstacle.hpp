#pragma once

#include <Eigen/Core>
#include <string>

namespace understory {

/// A round bar between two points: a trunk, a goal post, a crossbar. World frame, m.
struct Obstacle {
  std::string name;
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();  ///< for a trunk: its foot
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();
  double radius_m = 0.15;
  double texture_turn_rad = 0;  ///< rotates the bark about the axis, so that no two trunks look the same
  double texture_shift = 0;     ///< 0 .. 1: shifts the bark along the axis
};

}  // namespace understory
