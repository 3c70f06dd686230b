#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/scene/obstacle.hpp"

namespace understory {

/// Triangles of a round bar in its own frame: axis along z from 0 to its length, outward normals, one texture
/// coordinate per vertex.
struct TrunkMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< m
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Vector2d> texture;  ///< in tiles
  std::vector<Eigen::Vector3i> faces;    ///< counter-clockwise from outside
};

/// Maximum distance between the drawn outline and the colliding one, m.
constexpr double silhouette_tolerance_m = 0.0065;

/// A prism (closed, but for a foot on the ground) whose silhouette stays within the tolerance of the bar's: 6
/// sides for a thin post, 8 or 10 for trunks. The bark goes round a whole number of times, so that it has no
/// seam, and is about as large as on a tile of `tile_width_m` x `tile_height_m`.
TrunkMesh trunk_mesh(const Obstacle& obstacle, double tile_width_m, double tile_height_m);

}  // namespace understory
