#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/scene/trees.hpp"
#include "sim/scene/woods_textures.hpp"

namespace understory {

/// A corner of a drawn triangle. The tint holds the light that falls on it: 128 leaves the texture as it is.
struct WoodsVertex {
  std::array<float, 3> position_world;
  std::array<float, 2> texture;
  std::array<std::uint8_t, 4> tint;    ///< red, green, blue; the fourth is how much of the dapple falls on it
  std::array<std::uint8_t, 4> object;  ///< its number in images of objects, low byte first; two unused
};

/// Indices of a part's triangles.
struct WoodsRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// What is culled and drawn as a whole: a tree, a piece of ground with its plants, a tree of the far wood.
struct WoodsPart {
  Eigen::AlignedBox3d box_world;
  /// Solid pieces near and far, cut-out leaves near and far.
  std::array<WoodsRange, 2> solid, leaves;
  WoodsTexture texture = WoodsTexture::ground;  ///< of the solid pieces
};

/// Everything that is drawn of a wood, ready for the GPU's memory.
struct WoodsMesh {
  std::vector<WoodsVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<WoodsPart> parts;
  std::array<WoodsPicture, woods_texture_count> textures;  ///< empty where no part uses it
  WoodsPicture dapple;                                     ///< light through the crowns, on the ground
  Eigen::Vector3d to_sun_world = Eigen::Vector3d::UnitZ();
  double haze_m = 100;
};

/// Numbers in images of objects: each tree has one for its trunk, its branches and its leaves, the plants of
/// the ground have one in all, and what stands beyond the course has one.
struct WoodsNumbers {
  std::uint16_t trunk(std::size_t tree) const;
  std::uint16_t branch(std::size_t tree) const { return static_cast<std::uint16_t>(trunk(tree) + 1); }
  std::uint16_t leaves(std::size_t tree) const { return static_cast<std::uint16_t>(trunk(tree) + 2); }
  std::size_t trees = 0;
  std::uint16_t undergrowth() const { return trunk(trees); }
  std::uint16_t far_wood() const { return static_cast<std::uint16_t>(trunk(trees) + 1); }
};

/// Draws a wood that stands in a rectangle of the ground (corners in world axes, m) with a far wood around
/// it. The same arguments give the same bytes.
WoodsMesh woods_mesh(const std::vector<Obstacle>& obstacles, const std::vector<Tree>& trees,
                     const Eigen::AlignedBox2d& stand, const WoodsConfig& config, std::uint64_t seed);

}  // namespace understory
