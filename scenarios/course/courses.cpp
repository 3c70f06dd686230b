#include "scenarios/course/courses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/course/inventory.hpp"

namespace understory {

std::vector<Obstacle> random_forest(const ForestConfig& config, std::uint64_t seed) {
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
  if (config.stems == StemModel::inventory) draw_inventory_stems(config, seed, trees);
  std::sort(trees.begin(), trees.end(),
            [](const Obstacle& a, const Obstacle& b) { return a.from_world.x() < b.from_world.x(); });
  for (std::size_t i = 0; i < trees.size(); ++i) trees[i].name = fmt::format("tree_{:04}", i);
  return trees;
}

Obstacle placed(const ListedObstacle& listed) {
  Obstacle obstacle;
  obstacle.name = listed.name;
  obstacle.texture = listed.texture;
  const Eigen::Vector3d& turn = listed.rotation_rad;
  obstacle.turn_world = Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d half = 0.5 * listed.size_m, up = obstacle.turn_world * Eigen::Vector3d::UnitZ();
  double half_axis_m = half.z();
  switch (listed.shape) {
    case ListedShape::box:
      obstacle.kind = ObstacleKind::box;
      obstacle.half_size_m = half;
      obstacle.radius_m = half.head<2>().norm();
      break;
    case ListedShape::capsule:
      obstacle.kind = ObstacleKind::capsule;
      obstacle.radius_m = half.x();
      half_axis_m = std::max(0.0, half.z() - half.x());
      break;
    case ListedShape::sphere:
      obstacle.kind = ObstacleKind::sphere;
      obstacle.radius_m = half.x();
      half_axis_m = 0;
      break;
  }
  obstacle.from_world = listed.position_m - half_axis_m * up;
  obstacle.to_world = listed.position_m + half_axis_m * up;
  return obstacle;
}

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
  const double crossbar_z = config.crossbar_top_m - config.radius_m;
  std::vector<Obstacle> obstacles{
      {"near_upright", {near_x, near_y, 0}, {near_x, near_y, config.height_m}, config.radius_m, 0.7, 0.1},
      {"far_upright", {far_x, far_y, 0}, {far_x, far_y, config.height_m}, config.radius_m, 2.9, 0.6},
      {"crossbar", {near_x, near_y, crossbar_z}, {far_x, far_y, crossbar_z}, config.radius_m, 4.3, 0.4},
  };
  obstacles[0].kind = obstacles[1].kind = ObstacleKind::post;
  obstacles[2].kind = ObstacleKind::crossbar;
  return obstacles;
}

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

namespace {

/// A straight piece on the ground from `from` to `to`.
void add_piece(const FenceConfig& config, const std::string& name, const Eigen::Vector3d& from,
               const Eigen::Vector3d& to, std::vector<Obstacle>& obstacles) {
  const double length_m = (to - from).norm();
  const Eigen::Vector3d along = (to - from) / length_m;
  const int palings = static_cast<int>(std::floor(length_m / config.spacing_m)) + 1;
  for (int i = 0; i < palings; ++i) {
    const Eigen::Vector3d foot = from + i * config.spacing_m * along;
    Obstacle paling{fmt::format("{}_paling_{:03}", name, i), foot, foot, config.paling_radius_m};
    paling.to_world.z() = config.height_m;
    paling.kind = ObstacleKind::post;
    obstacles.push_back(paling);
  }
  for (const double share : {0.2, 0.8}) {
    const Eigen::Vector3d up(0, 0, share * config.height_m);
    Obstacle rail{fmt::format("{}_{}_rail", name, share < 0.5 ? "lower" : "upper"), from + up, to + up,
                  config.rail_radius_m};
    rail.kind = ObstacleKind::rail;
    obstacles.push_back(rail);
  }
}

}  // namespace

std::vector<Obstacle> fence(const FenceConfig& config, double goal_x_m) {
  std::vector<Obstacle> obstacles;
  int number = 1;
  for (double x = config.first_across_m; x < goal_x_m; x += config.across_apart_m, ++number)
    for (const double side : {1.0, -1.0})
      add_piece(config, fmt::format("across_{}_{}", number, side > 0 ? "left" : "right"),
                {x, side * 0.5 * config.opening_m, 0}, {x, side * config.reach_m, 0}, obstacles);
  const double from_x = config.first_across_m + config.spacing_m;  // two palings must not stand in one place
  if (from_x < goal_x_m)
    add_piece(config, "beside", {from_x, config.beside_m, 0}, {goal_x_m, config.beside_m, 0}, obstacles);
  return obstacles;
}

}  // namespace understory
