#include "scenarios/scenario/fence.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace understory {
namespace {

/// A straight piece on the ground from `from` to `to`.
void add_piece(const FenceConfig& config, const std::string& name, const Eigen::Vector3d& from,
               const Eigen::Vector3d& to, std::vector<Obstacle>& bars) {
  const double length_m = (to - from).norm();
  const Eigen::Vector3d along = (to - from) / length_m;
  const int palings = static_cast<int>(std::floor(length_m / config.spacing_m)) + 1;
  for (int i = 0; i < palings; ++i) {
    const Eigen::Vector3d foot = from + i * config.spacing_m * along;
    Obstacle paling{fmt::format("{}_paling_{:03}", name, i), foot, foot, config.paling_radius_m};
    paling.to_world.z() = config.height_m;
    paling.kind = ObstacleKind::post;
    bars.push_back(paling);
  }
  for (const double share : {0.2, 0.8}) {
    const Eigen::Vector3d up(0, 0, share * config.height_m);
    Obstacle rail{fmt::format("{}_{}_rail", name, share < 0.5 ? "lower" : "upper"), from + up, to + up,
                  config.rail_radius_m};
    rail.kind = ObstacleKind::rail;
    bars.push_back(rail);
  }
}

}  // namespace

std::vector<Obstacle> fence(const FenceConfig& config, double goal_x_m) {
  std::vector<Obstacle> bars;
  int number = 1;
  for (double x = config.first_across_m; x < goal_x_m; x += config.across_apart_m, ++number)
    for (const double side : {1.0, -1.0})
      add_piece(config, fmt::format("across_{}_{}", number, side > 0 ? "left" : "right"),
                {x, side * 0.5 * config.gate_m, 0}, {x, side * config.reach_m, 0}, bars);
  const double from_x = config.first_across_m + config.spacing_m;  // two palings must not stand in one place
  if (from_x < goal_x_m)
    add_piece(config, "beside", {from_x, config.beside_m, 0}, {goal_x_m, config.beside_m, 0}, bars);
  return bars;
}

}  // namespace understory
