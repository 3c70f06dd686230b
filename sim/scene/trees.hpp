#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/scene/obstacle.hpp"
#include "sim/scene/world_config.hpp"

namespace understory {

enum class TreeKind { oak, beech, birch, pine, spruce };
inline constexpr std::array<std::string_view, 5> tree_kind_names{"oak", "beech", "birch", "pine", "spruce"};

/// The measured values of a tree; unknown ones are drawn at random.
struct KnownTree {
  double height_m = 0;                  ///< of the whole tree; 0: unknown
  std::optional<Eigen::Vector2d> lean;  ///< horizontal displacement per metre of height; nothing: unknown
  std::optional<TreeKind> kind;
};

/// A grown tree: the data that its rendering needs besides its obstacles.
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

/// What stands on a course: obstacles in the order of the trees, and the trees; then those that stand alone.
struct Wood {
  std::vector<Obstacle> obstacles;
  std::vector<Tree> trees;
  Scenery scenery = Scenery::plain;  ///< woods: images number objects as WoodsNumbers says
};

/// Numbers in images of objects of a wood. Each tree has one for its trunk, its branches and its leaves; the
/// plants of the ground, the fallen logs and what stands beyond the course have one each; then come the
/// obstacles that stand alone, in their order. The first two are nothing and the ground, as everywhere.
struct WoodsNumbers {
  std::size_t trees = 0;

  std::size_t trunk(std::size_t tree) const { return object_first_obstacle + 3 * tree; }
  std::size_t branch(std::size_t tree) const { return trunk(tree) + 1; }
  std::size_t leaves(std::size_t tree) const { return trunk(tree) + 2; }
  std::size_t undergrowth() const { return trunk(trees); }
  std::size_t log() const { return trunk(trees) + 1; }
  std::size_t far_wood() const { return trunk(trees) + 2; }
  std::size_t alone(std::size_t number) const { return trunk(trees) + 3 + number; }
};

/// The look, with all values that its keys leave open drawn at random from the seed. `config` is as the keys
/// state it, not drawn before.
WoodsConfig drawn(WoodsConfig config, std::uint64_t seed);

/// Grows a tree where each trunk stands (`config` from drawn(); `known` is empty or as long as `trunks`): a
/// chain of capsules that leans, bends and tapers, and branches as shorter chains. A trunk's radius is that
/// at breast height, 1.3 m. The pieces of a trunk are so short that a capsule's radius differs from the
/// tapered one by less than 1 cm. Branches are at least 1 cm thick. Each piece is an Obstacle that names its
/// tree.
///
/// The height follows h = 2.0 d^0.68 (h in m, d in cm), fitted to 725 trees of the SCBI plot (Bourg et al.
/// 2013, Ecology 94, 2111), with 0.24 of standard deviation of log h.
Wood grow(const std::vector<Obstacle>& trunks, const WoodsConfig& config, std::uint64_t seed,
          const std::vector<KnownTree>& known = {});

}  // namespace understory
