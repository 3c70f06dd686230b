#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace understory {

/// Kind of an obstacle, for people.
enum class ObstacleKind { trunk, post, crossbar, rail, wall, branch, capsule, box, sphere };

inline constexpr std::array<std::string_view, 9> obstacle_kind_names{
    "trunk", "post", "crossbar", "rail", "wall", "branch", "capsule", "box", "sphere"};
constexpr std::string_view word_for(ObstacleKind kind) {
  return obstacle_kind_names[static_cast<std::size_t>(kind)];
}

/// Numbers in images of objects: nothing (the sky), the ground, then a course's obstacles in their order.
inline constexpr std::uint16_t object_nothing = 0;
inline constexpr std::uint16_t object_ground = 1;
inline constexpr std::uint16_t object_first_obstacle = 2;

/// What covers an obstacle of a scenario's own list.
enum class ObstacleTexture { bark, windows, litter };

/// A round obstacle between two points (trunk, goal post, crossbar, capsule; a sphere where both are one), a
/// wall, which is an upright rectangle with its diagonal between the points, twice the radius thick, or a
/// box. World frame, m.
struct Obstacle {
  std::string name;
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();  ///< for a trunk: its foot
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();
  double radius_m = 0.15;
  double texture_turn_rad = 0;  ///< rotates the bark about the axis, so that no two trunks look the same
  double texture_shift = 0;     ///< 0 .. 1: shifts the bark along the axis
  ObstacleKind kind = ObstacleKind::trunk;
  int tree = -1;  ///< number of the tree that it is a piece of; -1: it stands alone
  ObstacleTexture texture = ObstacleTexture::bark;
  /// Of a box, which lies between the points along its own z axis; its radius reaches to its edges.
  Eigen::Quaterniond turn_world = Eigen::Quaterniond::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();

  /// Whether its ends are half spheres: a trunk that stands alone ends flat, above the flight.
  bool has_round_ends() const {
    return tree >= 0 || kind == ObstacleKind::capsule || kind == ObstacleKind::sphere;
  }
  /// Of a box, from its own axes at its middle.
  Eigen::Isometry3d T_world_box() const;
};

}  // namespace understory
