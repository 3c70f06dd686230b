#include "sim/scene/facade.hpp"

#include <Eigen/Geometry>
#include <array>

namespace understory {
namespace {

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
