#include "sim/scene/meshes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

/// Corners lie outside the true circle and flats inside it, by the same amount.
double corner_radius_m(double radius_m, int sides) {
  return 2 * radius_m / (1 + std::cos(std::numbers::pi / sides));
}

/// The minimum number that keeps the silhouette within tolerance: vertices are the cost of a distant trunk.
int sides_of(double radius_m) {
  int sides = 6;
  while (corner_radius_m(radius_m, sides) - radius_m > silhouette_tolerance_m) sides += 2;
  return sides;
}

void add_cap(TrunkMesh& mesh, int sides, double radius, double z, double side) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    mesh.normals.emplace_back(0, 0, side);
    mesh.texture.emplace_back(0.5 * std::cos(angle) * radius, 0.5 * std::sin(angle) * radius);
  }
  for (int i = 1; i + 1 < sides; ++i)
    mesh.faces.emplace_back(first, first + (side > 0 ? i : i + 1), first + (side > 0 ? i + 1 : i));
}

/// Six faces; every face's picture stands upright where the face does.
TrunkMesh box_mesh(const Eigen::Vector3d& half_m, double tile_width_m, double tile_height_m) {
  TrunkMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int first = static_cast<int>(mesh.vertices.size());
      const int up = axis == 2 ? 1 : 2, across = 3 - axis - up;
      for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
        Eigen::Vector3d corner;
        corner[axis] = side * half_m[axis];
        corner[across] = u * half_m[across];
        corner[up] = v * half_m[up];
        mesh.vertices.push_back(corner);
        mesh.normals.push_back(side * Eigen::Vector3d::Unit(axis));
        mesh.texture.emplace_back(corner[across] / tile_width_m, (corner[up] + half_m[up]) / tile_height_m);
      }
      const bool outward = (axis == 1) != (side > 0);  // x, z and y are no right-handed axes
      mesh.faces.emplace_back(first, first + (outward ? 1 : 2), first + (outward ? 2 : 1));
      mesh.faces.emplace_back(first, first + (outward ? 2 : 3), first + (outward ? 3 : 2));
    }
  return mesh;
}

/// Rings about the z axis, half spheres at both ends of a straight piece.
TrunkMesh capsule_mesh(double radius_m, double half_axis_m, double tile_width_m, double tile_height_m) {
  // Finer than trunks: within 1 mm of the round surface.
  const int sides = std::max(12, static_cast<int>(std::ceil(std::numbers::pi * std::sqrt(radius_m / 0.004))));
  const int rings_per_end = sides / 2;
  const double girth_m = 2 * std::numbers::pi * radius_m,
               turns = std::max(1.0, std::round(girth_m / tile_width_m));
  TrunkMesh mesh;
  for (int ring = 0; ring < 2 * (rings_per_end + 1); ++ring) {
    const bool upper = ring > rings_per_end;
    const int step = upper ? ring - rings_per_end - 1 : ring - rings_per_end;
    const double angle = 0.5 * std::numbers::pi * step / rings_per_end;
    const double z = (upper ? half_axis_m : -half_axis_m) + radius_m * std::sin(angle);
    const double along_m = z + half_axis_m + radius_m;
    for (int i = 0; i <= sides; ++i) {
      const double share = static_cast<double>(i) / sides, turn = 2 * std::numbers::pi * share;
      const Eigen::Vector3d normal(std::cos(angle) * std::cos(turn), std::cos(angle) * std::sin(turn),
                                   std::sin(angle));
      const double around_m = corner_radius_m(radius_m, sides) * std::cos(angle);
      mesh.vertices.emplace_back(around_m * std::cos(turn), around_m * std::sin(turn), z);
      mesh.normals.push_back(normal);
      mesh.texture.emplace_back(turns * share, along_m / tile_height_m);
    }
    if (ring == 0) continue;
    const int high = ring * (sides + 1), low = high - sides - 1;
    for (int i = 0; i < sides; ++i) {
      if (ring > 1) mesh.faces.emplace_back(low + i, low + i + 1, high + i);
      if (ring < 2 * rings_per_end + 1) mesh.faces.emplace_back(low + i + 1, high + i + 1, high + i);
    }
  }
  return mesh;
}

/// A filled rectangle of the tile, in metres from its middle and from its foot.
struct Patch {
  double left_m, right_m, low_m, high_m;
  std::uint8_t gray;
};

/// Painted one over the other.
constexpr std::array<Patch, 9> patches{{
    {-0.475, 0.475, 2.65, 2.85, 120},  // lintel
    {-0.475, 0.475, 0.87, 0.95, 225},  // sill
    {-0.375, 0.375, 0.95, 2.65, 215},  // frame
    {-0.325, -0.025, 1.00, 1.50, 55},  // panes
    {0.025, 0.325, 1.00, 1.50, 55},
    {-0.325, -0.025, 1.55, 2.05, 55},
    {0.025, 0.325, 1.55, 2.05, 55},
    {-0.325, -0.025, 2.10, 2.60, 55},
    {0.025, 0.325, 2.10, 2.60, 55},
}};

/// Four corners in turn, counter-clockwise from outside, and what of the texture they bear.
void add_face(TrunkMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners,
              const std::array<Eigen::Vector2d, 4>& tiles) {
  const int first = static_cast<int>(mesh.vertices.size());
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized();
  for (std::size_t i = 0; i < 4; ++i) {
    mesh.vertices.push_back(corners[i]);
    mesh.normals.push_back(normal);
    mesh.texture.push_back(tiles[i]);
  }
  mesh.faces.emplace_back(first, first + 1, first + 2);
  mesh.faces.emplace_back(first, first + 2, first + 3);
}

}  // namespace

TrunkMesh trunk_mesh(const Obstacle& obstacle, double tile_width_m, double tile_height_m) {
  TrunkMesh mesh;
  const double length = (obstacle.to_world - obstacle.from_world).norm();
  const int sides = sides_of(obstacle.radius_m);
  const double radius = corner_radius_m(obstacle.radius_m, sides);
  const double girth_m = 2 * std::numbers::pi * obstacle.radius_m;
  const double turns = std::max(1.0, std::round(girth_m / tile_width_m));
  const double tiles_per_m = turns / girth_m * tile_width_m / tile_height_m;  // keeps the bark's proportions

  for (int i = 0; i <= sides; ++i) {
    const double share = static_cast<double>(i) / sides, angle = 2 * std::numbers::pi * share;
    for (const double z : {0.0, length}) {
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      mesh.normals.emplace_back(std::cos(angle), std::sin(angle), 0);
      mesh.texture.emplace_back(turns * share, z * tiles_per_m + obstacle.texture_shift);
    }
  }
  for (int i = 0; i < sides; ++i) {
    const int low = 2 * i, next = low + 2;
    mesh.faces.emplace_back(low, next, next + 1);
    mesh.faces.emplace_back(low, next + 1, low + 1);
  }
  // A foot in the ground is never seen from below; vertices cost time in every picture.
  if (obstacle.from_world.z() > 0.01) add_cap(mesh, sides, radius, 0, -1);
  add_cap(mesh, sides, radius, length, 1);
  return mesh;
}

TrunkMesh listed_mesh(const Obstacle& obstacle) {
  const bool windowed = obstacle.texture == ObstacleTexture::windows,
             barked = obstacle.texture == ObstacleTexture::bark;
  const double width_m = windowed ? window_period_m : barked ? bark_width_m : ground_tile_m;
  const double height_m = windowed ? storey_m : barked ? bark_height_m : ground_tile_m;
  if (obstacle.kind == ObstacleKind::box) return box_mesh(obstacle.half_size_m, width_m, height_m);
  const double half_axis_m = 0.5 * (obstacle.to_world - obstacle.from_world).norm();
  return capsule_mesh(obstacle.radius_m, half_axis_m, width_m, height_m);
}

GrayTexture facade_texture(std::uint64_t seed) {
  TextureRequest plaster{
      .width_px = facade_width_px, .height_px = facade_height_px, .mean_gray = 165, .contrast = 0.02};
  plaster.seed = seed;
  GrayTexture texture = make_texture(plaster);
  const double column_m = window_period_m / texture.width_px, row_m = storey_m / texture.height_px;
  for (const Patch& patch : patches)
    for (int row = 0; row < texture.height_px; ++row)
      for (int column = 0; column < texture.width_px; ++column) {
        const double x_m = (column + 0.5) * column_m - 0.5 * window_period_m;
        const double z_m = storey_m - (row + 0.5) * row_m;
        if (x_m > patch.left_m && x_m < patch.right_m && z_m > patch.low_m && z_m < patch.high_m)
          texture.gray[static_cast<std::size_t>(row) * texture.width_px + column] = patch.gray;
      }
  return texture;
}

TrunkMesh facade_mesh(const Obstacle& wall) {
  const Eigen::Vector3d extent = wall.to_world - wall.from_world;
  const Eigen::Vector3d side(extent.x(), extent.y(), 0), up(0, 0, extent.z());
  const Eigen::Vector3d thick = wall.radius_m * Eigen::Vector3d::UnitZ().cross(side).normalized();
  const double width_tiles = side.norm() / window_period_m, height_tiles = extent.z() / storey_m;
  const std::array<Eigen::Vector2d, 4> windows{Eigen::Vector2d{-0.5 * width_tiles, height_tiles},
                                               {0.5 * width_tiles, height_tiles},
                                               {0.5 * width_tiles, 0},
                                               {-0.5 * width_tiles, 0}};
  const Eigen::Vector2d plaster_tile(0.02, 0.02);
  const std::array<Eigen::Vector2d, 4> plaster{plaster_tile, plaster_tile, plaster_tile, plaster_tile};
  TrunkMesh mesh;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  add_face(mesh, {zero - thick, side - thick, side + up - thick, up - thick}, windows);
  add_face(mesh, {side + thick, zero + thick, up + thick, side + up + thick}, windows);
  add_face(mesh, {zero + thick, zero - thick, up - thick, up + thick}, plaster);
  add_face(mesh, {side - thick, side + thick, side + up + thick, side + up - thick}, plaster);
  add_face(mesh, {up - thick, side + up - thick, side + up + thick, up + thick}, plaster);
  add_face(mesh, {zero + thick, side + thick, side - thick, zero - thick}, plaster);
  return mesh;
}

}  // namespace understory
