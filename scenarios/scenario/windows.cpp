#include "scenarios/scenario/windows.hpp"

namespace understory {

std::vector<Obstacle> windows(const WindowsConfig& config, double goal_x_m) {
  Obstacle wall;
  wall.name = "facade";
  wall.kind = ObstacleKind::wall;
  wall.radius_m = 0.2;
  const double x = goal_x_m + config.behind_goal_m + wall.radius_m;
  wall.from_world = {x, -0.5 * config.width_m, 0};
  wall.to_world = {x, 0.5 * config.width_m, config.height_m};
  return {wall};
}

}  // namespace understory
