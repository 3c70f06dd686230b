#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/scene/obstacle.hpp"
#include "sim/scene/textures.hpp"

namespace understory {

/// Triangles of an obstacle in its own frame (of a trunk: axis along z from 0 to its length), outward
/// normals, one texture coordinate per vertex.
struct TrunkMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< m
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Vector2d> texture;  ///< in tiles
  std::vector<Eigen::Vector3i> faces;    ///< counter-clockwise from outside
};

/// Maximum distance between the drawn outline and the colliding one, m.
constexpr double silhouette_tolerance_m = 0.0065;

/// A prism (closed, except for a foot on the ground) whose silhouette stays within the tolerance of the
/// obstacle's: 6 sides for a thin post, 8 or 10 for trunks. The bark goes round a whole number of times, so
/// that it has no seam, and is about as large as on a tile of `tile_width_m` x `tile_height_m`.
TrunkMesh trunk_mesh(const Obstacle& obstacle, double tile_width_m, double tile_height_m);

// A wall's face: equal windows on plain plaster, one window a tile.
inline constexpr double window_period_m = 1.2;
inline constexpr double storey_m = 3.0;
inline constexpr int facade_width_px = 256;
inline constexpr int facade_height_px = 512;

/// One tile, the ground side last: a window of two by three panes in a pale frame between lintel and sill,
/// 0.75 x 1.7 m, one pane 0.375 m from the next. The plaster has almost no texture.
GrayTexture facade_texture(std::uint64_t seed);

// Tiles of the other pictures.
inline constexpr double bark_width_m = 0.8, bark_height_m = 1.6;  ///< 3.1 mm a texel
inline constexpr double ground_tile_m = 8.0;                      ///< 7.8 mm a texel

/// A box, capsule or sphere of a scenario's own list, in the frame of Obstacle::T_world_box(), with the tiles
/// of its picture.
TrunkMesh listed_mesh(const Obstacle& obstacle);

/// A wall's box, in world axes with its foot at its from_world. Tiles begin at its middle and at its foot.
TrunkMesh facade_mesh(const Obstacle& wall);

}  // namespace understory
