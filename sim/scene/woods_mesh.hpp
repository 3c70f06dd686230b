#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "sim/scene/trees.hpp"
#include "sim/scene/woods_textures.hpp"

namespace understory {

/// A corner of a drawn triangle. The tint holds the light that falls on it: 128 leaves the texture as it is.
struct WoodsVertex {
  std::array<float, 3> position_world;
  std::array<float, 2> texture;
  std::array<std::uint8_t, 4> tint;    ///< red, green, blue; the fourth is unused
  std::array<std::uint8_t, 4> object;  ///< its number in images of objects, low byte first; two unused
  /// Of a ribbon's corner, which is drawn beside the place: the ribbon's direction, as long as half of its
  /// width, with the other sign on the other side. Zero for all other corners.
  std::array<float, 3> ribbon;
};

/// Indices of a part's triangles, in those of its piece.
struct WoodsRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// What is culled and drawn as a whole: a stem, a crown, a piece of ground with its plants, a tree of the far
/// wood.
struct WoodsPart {
  Eigen::AlignedBox3d box_world;
  Eigen::AlignedBox3d whole_world;  ///< of the tree that it is a piece of: says how far away it is
  /// Solid pieces near and far, cut-out leaves near and far.
  std::array<WoodsRange, 2> solid, leaves;
  /// The near solid pieces with half of their sides: of tubes, whose insides nobody sees. Empty: they have
  /// none.
  WoodsRange coarse;
  WoodsTexture texture = WoodsTexture::ground;  ///< of the solid pieces
  std::uint32_t piece = 0;
};

struct WoodsTriangles {
  std::vector<WoodsVertex> vertices;
  std::vector<std::uint32_t> indices;
};

class MeshBuilder;

/// What is grown at once, as a few parts: a tree, a listed obstacle, a patch of the floor, a far tree with
/// its thicket.
struct WoodsPiece {
  std::function<void(MeshBuilder&)> grow;
  std::mt19937_64 generator;      ///< as it was before the piece grew
  Eigen::AlignedBox3d box_world;  ///< around its parts
  std::size_t vertex_count = 0, index_count = 0;
  WoodsTriangles triangles;  ///< empty where the wood is large: then the piece is grown again to be drawn
};

/// A drawn square of a tree's leaves: its middle, and from there half of its width and of its height.
struct LeafCard {
  Eigen::Vector3d middle_world, x_m, y_m;
};

/// Everything that is drawn of a wood. The triangles of a wood of a kilometre would fill 200 MB: a large one
/// keeps none.
struct WoodsMesh {
  std::vector<WoodsPiece> pieces;
  std::vector<WoodsPart> parts;    ///< obstacles first, then the floor and the far wood
  std::size_t obstacle_parts = 0;  ///< number of parts that are obstacles
  std::array<WoodsPicture, woods_texture_count> textures;  ///< empty until painted, and where no part uses it
  std::vector<LeafCard> leaf_cards;                        ///< of the trees that can be reached
  Eigen::Vector3d to_sun_world = Eigen::Vector3d::UnitZ();
  double haze_m = 100;
  double overcast = 0;
  std::uint32_t seed = 0;                ///< of the textures
  std::function<MeshBuilder()> builder;  ///< to grow pieces again
};

/// Calls `use` with the triangles of each of these pieces, one after the other.
void visit_triangles(const WoodsMesh& mesh, std::span<const std::uint32_t> pieces,
                     const std::function<void(std::uint32_t piece, const WoodsTriangles&)>& use);

/// Paints the textures, which only images need.
void paint(WoodsMesh& mesh);

/// Draws a wood that stands in a rectangle of the ground (corners in world axes, m) with a far wood around
/// it that keeps out of the course, a rectangle too, without textures. The same arguments give the same
/// bytes.
WoodsMesh woods_mesh(const std::vector<Obstacle>& obstacles, const std::vector<Tree>& trees,
                     const Eigen::AlignedBox2d& stand, const Eigen::AlignedBox2d& course,
                     const WoodsConfig& config, std::uint64_t seed);

}  // namespace understory
