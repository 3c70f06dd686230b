#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene/obstacle.hpp"
#include "sim/scene/world_config.hpp"

namespace understory {

enum class TreeKind { oak, beech, birch, pine, spruce };

/// A grown tree: what its drawing needs beside its obstacles.
struct Tree {
  TreeKind kind = TreeKind::oak;
  std::size_t first = 0;  ///< of its obstacles, the trunk's pieces from the foot up before the branches
  std::size_t trunk_pieces = 0;
  std::size_t branches = 0;   ///< pieces of branches, dead ones first
  double height_m = 0;        ///< of the whole tree, crown included; the obstacles end lower
  double crown_base_m = 0;    ///< height of the lowest living branch
  double crown_radius_m = 0;  ///< reach of the longest branch
  std::uint64_t seed = 0;     ///< its own, for what has no obstacle: leaves, tint
};

/// A wood: obstacles in the order of the trees, and the trees.
struct Wood {
  std::vector<Obstacle> obstacles;
  std::vector<Tree> trees;
};

/// The look, with what its keys leave open drawn from the seed: nothing is left open afterwards.
WoodsConfig drawn(WoodsConfig config, std::uint64_t seed);

/// Grows a tree where each upright trunk stands (`config` from drawn()): a chain of capsules that leans,
/// bends and tapers, and branches as shorter chains. A trunk's radius is that at breast height, 1.3 m. The
/// pieces of a trunk are so short that a capsule's radius differs from the tapered one by less than 1 cm.
/// Branches are at least 1 cm thick. Each piece is an Obstacle that names its tree.
///
/// The height follows h = 2.0 d^0.68 (h in m, d in cm), fitted to 725 trees of the SCBI plot (Bourg et al.
/// 2013, Ecology 94, 2111), with 0.24 of standard deviation of log h.
Wood grow(const std::vector<Obstacle>& trunks, const WoodsConfig& config, std::uint64_t seed);

}  // namespace understory
