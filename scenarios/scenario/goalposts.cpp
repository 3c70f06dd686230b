#include "scenarios/scenario/goalposts.hpp"

#include <cmath>
#include <random>

#include "scenarios/config/named_seed.hpp"

namespace understory {

std::vector<Obstacle> goalposts(const GoalpostsConfig& config, std::uint64_t seed) {
  std::mt19937_64 generator(seed_for(seed, "goalposts"));
  std::uniform_real_distribution<double> unit(0, 1);
  const double side = unit(generator) < 0.5 ? -1 : 1;
  const double pass_m =
      config.pass_minimum_m + unit(generator) * (config.pass_maximum_m - config.pass_minimum_m);
  const double near_y = side * (pass_m + config.radius_m);
  const double between_axes_m = config.width_m + 2 * config.radius_m;
  const double far_y = near_y - side * between_axes_m * std::cos(config.turn_rad);
  const double near_x = config.ahead_m;
  const double far_x = near_x + between_axes_m * std::sin(config.turn_rad);
  const double bar_z = config.crossbar_top_m - config.radius_m;
  std::vector<Obstacle> bars{
      {"near_upright", {near_x, near_y, 0}, {near_x, near_y, config.height_m}, config.radius_m, 0.7, 0.1},
      {"far_upright", {far_x, far_y, 0}, {far_x, far_y, config.height_m}, config.radius_m, 2.9, 0.6},
      {"crossbar", {near_x, near_y, bar_z}, {far_x, far_y, bar_z}, config.radius_m, 4.3, 0.4},
  };
  bars[0].kind = bars[1].kind = ObstacleKind::post;
  bars[2].kind = ObstacleKind::crossbar;
  return bars;
}

}  // namespace understory
