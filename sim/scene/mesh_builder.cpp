#include "sim/scene/mesh_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace understory {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double tile_width_m = 0.7, tile_height_m = 1.4;  ///< of bark
constexpr double relief_m = 0.12;
constexpr std::size_t most_kept_bytes = 64'000'000;

/// Where a picture of leaves has leaves, x and y from -1 to 1: what lies outside costs time and shows
/// nothing.
std::vector<Vector2d> outline_of(LeafPicture picture) {
  switch (picture) {
    case LeafPicture::needles:  // wider to the right
      return {{-1, -0.46}, {1, -1}, {1, 1}, {-1, 0.46}};
    case LeafPicture::frond:
      return {{-0.05, -1}, {0.05, -1}, {0.8, 0.2}, {0.66, 0.94}, {-0.66, 0.94}, {-0.8, 0.2}};
    case LeafPicture::fern:
      return {{-1, -1}, {1, -1}, {1, 0.8}, {-1, 0.8}};
    case LeafPicture::grass:
      return {{-0.5, -1}, {0.5, -1}, {1, 0.05}, {1, 0.88}, {-1, 0.88}, {-1, 0.05}};
    case LeafPicture::thicket:
      return {{-1, -1}, {1, -1}, {1, 0.05}, {0.45, 0.88}, {-1, 0.75}};
    case LeafPicture::leaves:
    case LeafPicture::more_leaves:
    case LeafPicture::twigs:
      break;
  }
  return {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
}

/// Along the line of points, from the one before to the one after.
Vector3d direction_at(const std::vector<Vector3d>& axis, std::size_t i) {
  return (axis[std::min(i + 1, axis.size() - 1)] - axis[i > 0 ? i - 1 : 0]).normalized();
}

}  // namespace

double noise_at(const Vector2d& place, std::uint32_t seed) {
  const auto node = [&](std::int64_t x, std::int64_t y) {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                      static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu ^ seed;
    h = (h ^ (h >> 31)) * 0xbf58476d1ce4e5b9u;
    return static_cast<double>((h ^ (h >> 29)) & 0xffff) / 32767.5 - 1;
  };
  const auto x = static_cast<std::int64_t>(std::floor(place.x())),
             y = static_cast<std::int64_t>(std::floor(place.y()));
  const double u = place.x() - std::floor(place.x()), v = place.y() - std::floor(place.y());
  const double s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
  const double low = node(x, y) + s * (node(x + 1, y) - node(x, y));
  const double high = node(x, y + 1) + s * (node(x + 1, y + 1) - node(x, y + 1));
  return low + t * (high - low);
}

MeshBuilder::MeshBuilder(const WoodsConfig& config, std::uint64_t seed)
    : noise_seed(static_cast<std::uint32_t>(seed)),
      generator_(seed),
      sun_share_(1 - config.overcast),
      dapple_(dapple_picture(noise_seed, config.overcast)) {
  const double azimuth = uniform(0, 2 * std::numbers::pi), up = config.sun_elevation_rad;
  mesh.to_sun_world = {std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up)};
  mesh.haze_m = config.haze_m;
  mesh.overcast = config.overcast;
  mesh.seed = noise_seed;
}

double MeshBuilder::ground_z(const Vector2d& place) const {
  return relief_m * (noise_at(place / 9, noise_seed) + 0.5 * noise_at(place / 5, noise_seed + 1) - 1.5);
}

Vector3d MeshBuilder::lit(const Vector3d& tint, const Vector3d& normal) const {
  const double sun = std::max(0.0, normal.dot(mesh.to_sun_world)), sky = 0.5 + 0.5 * normal.z();
  return tint * (0.5 + 0.3 * sky + (0.15 + 0.35 * sun) * sun_share_);
}

/// Patches of sun, as they fall slantwise through the crowns.
double MeshBuilder::sun_at(const Vector3d& place) const {
  const double along = place.z() / std::max(mesh.to_sun_world.z(), 0.3);
  const Vector2d there = (place.head<2>() - along * mesh.to_sun_world.head<2>()) / dapple_tile_m;
  const auto texel = [&](double share, int size) {
    return static_cast<int>(std::floor((share - std::floor(share)) * size)) % size;
  };
  const int x = texel(there.x(), dapple_.width_px), y = texel(there.y(), dapple_.height_px);
  return dapple_.rgba[static_cast<std::size_t>(4 * (y * dapple_.width_px + x))] / 128.0;
}

void MeshBuilder::add_piece(std::function<void(MeshBuilder&)> grow) {
  WoodsPiece piece{std::move(grow), generator_, {}, 0, 0, {}};
  const std::size_t first = mesh.parts.size();
  piece.grow(*this);
  for (std::size_t i = first; i < mesh.parts.size(); ++i) {
    mesh.parts[i].piece = static_cast<std::uint32_t>(mesh.pieces.size());
    piece.box_world.extend(mesh.parts[i].whole_world);
  }
  piece.vertex_count = triangles.vertices.size();
  piece.index_count = triangles.indices.size();
  kept_bytes_ += piece.vertex_count * sizeof(WoodsVertex) + piece.index_count * sizeof(std::uint32_t);
  if (kept_bytes_ <= most_kept_bytes)
    piece.triangles = std::exchange(triangles, {});
  else
    for (WoodsPiece& kept : mesh.pieces) kept.triangles = {};
  triangles = {};
  mesh.pieces.push_back(std::move(piece));
}

const WoodsTriangles& MeshBuilder::grown_again(const WoodsPiece& piece) {
  generator_ = piece.generator;
  triangles = {};
  mesh.parts.clear();
  mesh.leaf_cards.clear();
  piece.grow(*this);
  return triangles;
}

void MeshBuilder::begin_part(WoodsTexture texture) {
  part_ = {};
  part_.texture = texture;
}

Eigen::AlignedBox3d MeshBuilder::box_of(const WoodsRange& range) const {
  Eigen::AlignedBox3d box;
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    const std::array<float, 3>& place = triangles.vertices[triangles.indices[i]].position_world;
    box.extend(Vector3d(place[0], place[1], place[2]));
  }
  return box;
}

std::uint32_t MeshBuilder::add_vertex(const Vector3d& place, double u, double v, const Vector3d& tint,
                                      std::uint16_t object) {
  WoodsVertex vertex{};
  for (int i = 0; i < 3; ++i) {
    vertex.position_world[i] = static_cast<float>(place[i]);
    vertex.tint[i] = static_cast<std::uint8_t>(std::clamp(tint[i], 0.0, 255.0));
  }
  vertex.tint[3] = 255;
  vertex.texture = {static_cast<float>(u), static_cast<float>(v)};
  vertex.object = {static_cast<std::uint8_t>(object & 255), static_cast<std::uint8_t>(object >> 8), 0, 255};
  triangles.vertices.push_back(vertex);
  part_.box_world.extend(place);
  return static_cast<std::uint32_t>(triangles.vertices.size() - 1);
}

void MeshBuilder::add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  for (const std::uint32_t index : {a, b, c, a, c, d}) triangles.indices.push_back(index);
}

void MeshBuilder::add_tube(const std::vector<Vector3d>& axis, const std::vector<double>& radii_m, int sides,
                           const Vector3d& tint, double turn_rad, std::uint16_t object) {
  const double outside = 2 / (1 + std::cos(std::numbers::pi / sides));
  const double around = std::max(1.0, std::round(2 * std::numbers::pi * radii_m.front() / tile_width_m));
  double along_m = 0;
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (i > 0) along_m += (axis[i] - axis[i - 1]).norm();
    const Vector3d direction = direction_at(axis, i);
    // The same direction for every ring, or the bark would twist where the axis bends.
    const Vector3d reference = std::abs(direction.z()) > 0.7 ? Vector3d::UnitX() : Vector3d::UnitZ();
    const Vector3d side = (reference - reference.dot(direction) * direction).normalized();
    const Vector3d other = direction.cross(side);
    const auto ring = static_cast<std::uint32_t>(triangles.vertices.size());
    const double sun = sun_at(axis[i]);
    for (int corner = 0; corner <= sides; ++corner) {
      const double angle = turn_rad + 2 * std::numbers::pi * corner / sides;
      const Vector3d out = std::cos(angle) * side + std::sin(angle) * other;
      add_vertex(axis[i] + outside * radii_m[i] * out, around * corner / sides, along_m / tile_height_m,
                 lit(sun * tint, out), object);
    }
    for (int corner = 0; i > 0 && corner < sides; ++corner) {
      const auto low = before + static_cast<std::uint32_t>(corner),
                 high = ring + static_cast<std::uint32_t>(corner);
      add_quad(low, low + 1, high + 1, high);
    }
    before = ring;
  }
}

void MeshBuilder::add_ribbon(const std::vector<Vector3d>& axis, const std::vector<double>& radii_m,
                             const Vector3d& tint, std::uint16_t object) {
  const double half_round = std::max(0.5, std::round(std::numbers::pi * radii_m.front() / tile_width_m));
  double along_m = 0;
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (i > 0) along_m += (axis[i] - axis[i - 1]).norm();
    const Vector3d direction = direction_at(axis, i);
    const auto pair = static_cast<std::uint32_t>(triangles.vertices.size());
    const Vector3d shaded = lit(sun_at(axis[i]) * tint, mesh.to_sun_world.cross(direction).unitOrthogonal());
    for (const double side : {-1.0, 1.0}) {
      add_vertex(axis[i], half_round * (0.5 + 0.5 * side), along_m / tile_height_m, shaded, object);
      const Vector3d beside = side * radii_m[i] * direction;
      for (int axis_of = 0; axis_of < 3; ++axis_of)
        triangles.vertices.back().ribbon[axis_of] = static_cast<float>(beside[axis_of]);
    }
    if (i > 0) add_quad(before, before + 1, pair + 1, pair);
    before = pair;
  }
}

void MeshBuilder::add_card(const Card& card, const Vector3d& low_tint, const Vector3d& high_tint,
                           std::uint16_t object) {
  const auto cell = static_cast<int>(card.picture);
  const double u = 0.25 * (cell % 4), v = 0.5 * (cell / 4);
  constexpr double inset_u = 0.002, inset_v = 0.004;
  const std::vector<Vector2d> outline = outline_of(card.picture);
  const auto first = static_cast<std::uint32_t>(triangles.vertices.size());
  for (const Vector2d& at : outline) {
    const Vector2d share = 0.5 * (at + Vector2d::Ones());
    add_vertex(card.middle + at.x() * card.x + at.y() * card.y,
               u + inset_u + share.x() * (0.25 - 2 * inset_u), v + inset_v + share.y() * (0.5 - 2 * inset_v),
               low_tint + share.y() * (high_tint - low_tint), object);
  }
  for (std::uint32_t corner = 2; corner < outline.size(); ++corner)
    for (const std::uint32_t index : {0u, corner - 1, corner}) triangles.indices.push_back(first + index);
}

}  // namespace understory
