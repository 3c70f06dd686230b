#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene/obstacle.hpp"

namespace understory {

/// A forest in the launch frame: x ahead, y to the left. Its length also sets the goal plane of every other
/// course.
struct ForestConfig {
  double square_metres_per_tree = 49;  ///< mean ground area a tree has: 49 is 7 m spacing, 25 is dense
  double radius_min_m = 0.10;          ///< trunk radii are uniform between these two
  double radius_max_m = 0.25;
  double clear_m = 15;        ///< no tree before this x: room for launch and climb
  double length_m = 60;       ///< of the forest behind it; the goal plane stands at clear_m + length_m
  double half_width_m = 25;   ///< trees stand, and flight is allowed, to this |y|
  double trunk_height_m = 9;  ///< reaches above the altitude band: there is no way over
  bool invisible = false;     ///< trees collide and are not drawn
  bool intangible = false;    ///< trees are drawn and harmless
};

template <typename Visitor>
void visit_fields(Visitor& visit, ForestConfig& config) {
  visit("square_metres_per_tree", config.square_metres_per_tree, 4.0, 100000.0);
  visit("radius_min_m", config.radius_min_m, 0.01, 2.0);
  visit("radius_max_m", config.radius_max_m, 0.01, 2.0);
  visit("clear_m", config.clear_m, 0.0, 1000.0);
  visit("length_m", config.length_m, 1.0, 1000.0);
  visit("half_width_m", config.half_width_m, 1.0, 200.0);
  visit("trunk_height_m", config.trunk_height_m, 1.0, 60.0);
  visit("invisible", config.invisible);
  visit("intangible", config.intangible);
}

/// A Poisson forest: the number of trees is Poisson with mean area / square_metres_per_tree, each tree
/// uniform over the forest's rectangle, independent of the others; trunks may therefore overlap, as in the
/// theory of flight through Poisson forests (Karaman & Frazzoli 2012). Sorted by x. The generator is the
/// forest's own, from `seed`.
std::vector<Obstacle> poisson_forest(const ForestConfig& config, std::uint64_t seed);

}  // namespace understory
