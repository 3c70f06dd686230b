#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace understory {

/// Kind of an obstacle, for people.
enum class ObstacleKind { trunk, post, crossbar, rail, wall, branch };

inline constexpr std::array<std::string_view, 6> obstacle_kind_names{"trunk", "post", "crossbar",
                                                                     "rail",  "wall", "branch"};
constexpr std::string_view word_for(ObstacleKind kind) {
  return obstacle_kind_names[static_cast<std::size_t>(kind)];
}

/// Numbers in images of objects: nothing (the sky), the ground, then a course's obstacles in their order.
inline constexpr std::uint16_t object_nothing = 0;
inline constexpr std::uint16_t object_ground = 1;
inline constexpr std::uint16_t object_first_obstacle = 2;

/// A round obstacle between two points (trunk, goal post, crossbar), or a wall: an upright rectangle with its
/// diagonal between the points, twice the radius thick. World frame, m.
struct Obstacle {
  std::string name;
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();  ///< for a trunk: its foot
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();
  double radius_m = 0.15;
  double texture_turn_rad = 0;  ///< rotates the bark about the axis, so that no two trunks look the same
  double texture_shift = 0;     ///< 0 .. 1: shifts the bark along the axis
  ObstacleKind kind = ObstacleKind::trunk;
  int tree = -1;  ///< number of the tree that it is a piece of; -1: it stands alone
};

}  // namespace understory
