#include "sim/scene/trunk_mesh.hpp"

#include <algorithm>
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

}  // namespace understory
