#include "sim/scene/trees.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace understory {
namespace {

constexpr double breast_height_m = 1.3;
constexpr double longest_piece_m = 1.25;
constexpr double within_m = 0.006;   ///< of the taper
constexpr double thinnest_m = 0.01;  ///< radius of a branch's tip

/// Habit of a kind, as field guides draw it for trees in a closed stand; numbers are our choice.
struct Habit {
  double lean_rad;        ///< standard deviation from upright
  double bend_m;          ///< standard deviation of the sideways displacement over 9 m
  double dead_stubs;      ///< mean number below the crown
  double branch_every_m;  ///< mean distance between living branches along the stem
  double branch_rad;      ///< angle between branch and stem, from the tip
  double droop;           ///< share by which a branch's outer half turns down
  double crown_share;     ///< reach of the longest branch over the tree's height
};

constexpr std::array<Habit, 5> habits{{{0.035, 0.12, 3, 0.7, 1.05, 0.0, 0.22},      // oak
                                       {0.030, 0.08, 1, 0.7, 0.85, 0.0, 0.20},      // beech
                                       {0.045, 0.15, 1, 0.6, 0.75, 0.45, 0.14},     // birch
                                       {0.025, 0.06, 6, 0.8, 1.35, 0.0, 0.12},      // pine
                                       {0.015, 0.02, 8, 0.45, 1.60, 0.25, 0.13}}};  // spruce

/// Draws in a fixed order: a change to one tree changes no other.
class Grower {
 public:
  Grower(const Obstacle& trunk, const KnownTree& known, const WoodsConfig& config, int number,
         std::uint64_t seed, Wood& wood)
      : trunk_(trunk), known_(known), config_(config), number_(number), generator_(seed), wood_(wood) {
    tree_.seed = seed;
    tree_.first = wood.obstacles.size();
  }

  void grow() {
    const int any_kind = std::min(static_cast<int>(uniform(0, 5)), 4);  // drawn in any case
    tree_.kind =
        config_.kinds == WoodsKinds::mixed
            ? static_cast<TreeKind>(any_kind)
            : static_cast<TreeKind>(static_cast<int>(config_.kinds) - static_cast<int>(WoodsKinds::oak));
    tree_.kind = known_.kind.value_or(tree_.kind);
    habit_ = habits[static_cast<std::size_t>(tree_.kind)];
    const double diameter_cm = 200 * trunk_.radius_m;
    tree_.height_m = std::max(2.0 * std::pow(diameter_cm, 0.68) * std::exp(normal(0.24)), 4.0);
    if (known_.height_m > 0) tree_.height_m = std::max(known_.height_m, 2.0);
    tree_.crown_radius_m = habit_.crown_share * tree_.height_m;
    const double spread = uniform(0.8, 1.2);
    tree_.crown_base_m = config_.has_low_crowns
                             ? config_.lowest_branch_m * spread / 0.8
                             : std::max(config_.lowest_branch_m, 0.4 * tree_.height_m * spread);
    // A tree lower than that has its crown in its upper half.
    if (tree_.crown_base_m > 0.9 * tree_.height_m) tree_.crown_base_m = 0.5 * tree_.height_m;
    grow_trunk();
    grow_stubs();
    grow_branches();
    tree_.branches = wood_.obstacles.size() - tree_.first - tree_.trunk_pieces;
    wood_.trees.push_back(tree_);
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(generator_);
  }
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(generator_); }

  /// The stem's axis and radius at a height above the foot.
  Eigen::Vector3d axis_world(double height_m) const {
    const double along = height_m / trunk_.to_world.z();
    const Eigen::Vector2d aside = height_m * lean_ + 4 * along * (1 - along) * bend_m_;
    return trunk_.from_world + Eigen::Vector3d(aside.x(), aside.y(), height_m);
  }
  double radius_m(double height_m) const {
    const double left = (tree_.height_m - height_m) / (tree_.height_m - breast_height_m);
    return std::max(trunk_.radius_m * left, thinnest_m);
  }

  void add(const char* name, ObstacleKind kind, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
           double radius) {
    Obstacle piece = trunk_;
    piece.name = trunk_.name + name;
    piece.kind = kind;
    piece.from_world = from;
    piece.to_world = to;
    piece.radius_m = radius;
    piece.tree = number_;
    wood_.obstacles.push_back(std::move(piece));
  }

  void grow_trunk() {
    lean_ = {normal(habit_.lean_rad), normal(habit_.lean_rad)};
    lean_ = known_.lean.value_or(lean_);
    bend_m_ = {normal(habit_.bend_m), normal(habit_.bend_m)};
    const double top_m = std::min(trunk_.to_world.z(), 0.9 * tree_.height_m);
    // The capsule differs from the taper by half a piece's taper at its ends.
    const double taper = trunk_.radius_m / (tree_.height_m - breast_height_m);
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(top_m / std::min(longest_piece_m, 2 * within_m / taper))));
    for (int i = 0; i < pieces; ++i) {
      const double low = i * top_m / pieces, high = (i + 1) * top_m / pieces;
      add("", ObstacleKind::trunk, axis_world(low), axis_world(high), radius_m(0.5 * (low + high)));
    }
    tree_.trunk_pieces = static_cast<std::size_t>(pieces);
    top_m_ = top_m;
  }

  /// A branch of two pieces, the outer one drooping; `tip_m` is its radius at the tip.
  void grow_branch(double height_m, double length_m, double from_radius_m, double out_rad, bool dead) {
    const double turn = uniform(0, 2 * std::numbers::pi);
    const Eigen::Vector3d outward(std::cos(turn), std::sin(turn), 0);
    const Eigen::Vector3d first = std::sin(out_rad) * outward + std::cos(out_rad) * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d from = axis_world(height_m), middle = from + 0.5 * length_m * first;
    const double thick_m = std::max(from_radius_m, thinnest_m);
    if (dead) {
      add("_stub", ObstacleKind::branch, from, from + length_m * first, thick_m);
      return;
    }
    const Eigen::Vector3d second =
        (first + Eigen::Vector3d(0, 0, -habit_.droop * std::sin(out_rad))).normalized();
    add("_branch", ObstacleKind::branch, from, middle, thick_m);
    add("_branch", ObstacleKind::branch, middle, middle + 0.5 * length_m * second,
        std::max(0.6 * thick_m, thinnest_m));
  }

  void grow_stubs() {
    const double top_m = std::min(tree_.crown_base_m, top_m_);
    const int count = std::poisson_distribution<int>(habit_.dead_stubs)(generator_);
    for (int i = 0; i < count; ++i) {
      const double height_m = uniform(1.5, std::max(top_m, 1.6));
      const double beyond_bark_m = uniform(0.1, 0.5);
      grow_branch(height_m, radius_m(height_m) + beyond_bark_m, uniform(0.01, 0.018), uniform(1.0, 1.7),
                  true);
    }
  }

  /// Only those that begin below the obstacles' top: the crown above them is drawn without obstacles.
  void grow_branches() {
    for (double height_m = tree_.crown_base_m; height_m < top_m_;
         height_m += habit_.branch_every_m * uniform(0.6, 1.4)) {
      const double share = 1 - 0.6 * (height_m - tree_.crown_base_m) / tree_.height_m;
      const double length_m = tree_.crown_radius_m * share * uniform(0.6, 1.0);
      grow_branch(height_m, length_m, 0.012 * length_m, habit_.branch_rad * uniform(0.85, 1.15), false);
    }
  }

  const Obstacle& trunk_;
  const KnownTree& known_;
  const WoodsConfig& config_;
  int number_;
  std::mt19937_64 generator_;
  Wood& wood_;
  Tree tree_;
  Habit habit_{};
  Eigen::Vector2d lean_ = Eigen::Vector2d::Zero(), bend_m_ = Eigen::Vector2d::Zero();
  double top_m_ = 0;
};

}  // namespace

WoodsConfig drawn(WoodsConfig config, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(generator);
  };
  // Each is drawn whether it is needed or not, so that a key that is said changes no other.
  const int kinds = std::min(static_cast<int>(uniform(0, 7)), 6);  // mixed twice as often as each kind
  const double lowest_branch_m = uniform(6, 8), undergrowth = uniform(0.2, 1), haze_m = uniform(60, 250);
  const double sun_elevation_rad = uniform(0.15, 1.2), winter = uniform(0, 1), fallen_logs = uniform(0, 80);
  const double litter = uniform(0, 1), leaf_tone = uniform(0, 1), overcast = uniform(0, 1);
  if (config.kinds == WoodsKinds::any)
    config.kinds = static_cast<WoodsKinds>(std::max(static_cast<int>(WoodsKinds::mixed), kinds));
  config.has_low_crowns = config.lowest_branch_m > 0;
  if (!config.has_low_crowns) config.lowest_branch_m = lowest_branch_m;
  if (config.undergrowth < 0) config.undergrowth = undergrowth;
  if (config.season == Season::any) config.season = winter < 0.25 ? Season::winter : Season::summer;
  if (config.fallen_logs < 0) config.fallen_logs = fallen_logs;
  if (config.litter < 0) config.litter = litter;
  if (config.leaf_tone < 0) config.leaf_tone = leaf_tone;
  if (config.overcast < 0) config.overcast = overcast;
  if (config.haze_m == 0) config.haze_m = haze_m;
  if (config.sun_elevation_rad == 0) config.sun_elevation_rad = sun_elevation_rad;
  return config;
}

Wood grow(const std::vector<Obstacle>& trunks, const WoodsConfig& config, std::uint64_t seed,
          const std::vector<KnownTree>& known) {
  Wood wood;
  wood.scenery = Scenery::woods;
  const KnownTree unknown;
  for (std::size_t i = 0; i < trunks.size(); ++i) {
    std::seed_seq mixed{seed, seed >> 32, std::uint64_t{i}};
    std::array<std::uint32_t, 2> words{};
    mixed.generate(words.begin(), words.end());
    Grower(trunks[i], known.empty() ? unknown : known[i], config, static_cast<int>(i),
           std::uint64_t{words[1]} << 32 | words[0], wood)
        .grow();
  }
  return wood;
}

}  // namespace understory
