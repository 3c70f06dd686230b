#include "scenarios/scenario/forest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "scenarios/config/named_seed.hpp"

namespace understory {

std::vector<Obstacle> poisson_forest(const ForestConfig& config, std::uint64_t seed) {
  std::mt19937_64 generator(seed_for(seed, "forest"));
  const double area_m2 = config.length_m * 2 * config.half_width_m;
  std::poisson_distribution<int> count(area_m2 / config.square_metres_per_tree);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Obstacle> trees(static_cast<std::size_t>(count(generator)));
  for (Obstacle& tree : trees) {
    const double x = config.clear_m + unit(generator) * config.length_m;
    const double y = (2 * unit(generator) - 1) * config.half_width_m;
    tree.from_world = {x, y, 0};
    tree.to_world = {x, y, config.trunk_height_m};
    tree.radius_m = config.radius_min_m + unit(generator) * (config.radius_max_m - config.radius_min_m);
    tree.texture_turn_rad = 2 * std::numbers::pi * unit(generator);
    tree.texture_shift = unit(generator);
  }
  std::sort(trees.begin(), trees.end(),
            [](const Obstacle& a, const Obstacle& b) { return a.from_world.x() < b.from_world.x(); });
  for (std::size_t i = 0; i < trees.size(); ++i) trees[i].name = fmt::format("tree_{:04}", i);
  return trees;
}

}  // namespace understory
