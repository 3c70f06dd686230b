#include "scenarios/course/courses.hpp"

#include "perception/field_visitor.hpp"

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

void visit_fields(FieldVisitor& visit, ForestConfig& config) {
  visit("square_metres_per_tree", config.square_metres_per_tree, 4.0, 100000.0,
        "mean ground area per tree; 49 m^2: 204 trees per hectare, one per 7 m x 7 m");
  visit("stems", config.stems, stem_model_names,
        "How the seed draws a random forest's stems. uniform: radii evenly between forest.radius_min_m and "
        "radius_max_m, places independent; inventory: radii within the same limits and clusters of thin "
        "stems as in a measured forest | docs/woods.md");
  visit("radius_min_m", config.radius_min_m, 0.01, 2.0,
        "smallest trunk radius; radii are drawn uniformly up to forest.radius_max_m");
  visit("radius_max_m", config.radius_max_m, 0.01, 2.0, "largest radius of a trunk");
  visit("clear_m", config.clear_m, 0.0, 1000.0, "x at which the forest begins; the launch is at x = 0");
  visit("length_m", config.length_m, 1.0, 1000.0,
        "length of the forest; the goal of every course is the plane x = clear_m + length_m");
  visit("half_width_m", config.half_width_m, 1.0, 200.0,
        "Half the width of the forest. On every course of up to 100 m, a flight that strays farther to the "
        "side ends. Default on a longer course: 36 m, of which the autopilot keeps to 25 m.");
  visit("trunk_height_m", config.trunk_height_m, 1.0, 60.0,
        "height of the trunks; the default is above the altitude band, so that no flight passes over them");
  visit("trees_file", config.trees_file,
        "CSV file of measured stems that stand instead of random ones (docs/woods.md describes it). A "
        "relative path is looked for beside the scenario file, then in the folder that the environment "
        "variable UNDERSTORY_DATA names. Empty: random trees | docs/woods.md");
  visit("thinnest_stem_m", config.thinnest_stem_m, 0.001, 5.0,
        "diameter below which a stem of forest.trees_file is left out");
  visit("file_x_m", config.file_x_m, -1e7, 1e7,
        "x coordinate of the launch in forest.trees_file; empty: drawn from the seed so that the course lies "
        "among the stems");
  visit("file_y_m", config.file_y_m, -1e7, 1e7,
        "y coordinate of the launch in forest.trees_file; empty: drawn");
  visit("file_heading_rad", config.file_heading_rad, -6.3, 6.3,
        "direction of the flight in forest.trees_file, counter-clockwise from its x axis; empty: drawn");
  visit("invisible", config.invisible,
        "hides the obstacles of any course from the cameras; they still collide");
  visit("intangible", config.intangible,
        "lets the aircraft pass through the obstacles of any course; they are still drawn");
}

void visit_fields(FieldVisitor& visit, ListedObstacle& obstacle) {
  visit("name", obstacle.name, "name in results, unique in the list");
  visit("shape", obstacle.shape, listed_shape_names, "shape of the obstacle");
  visit("position_m", obstacle.position_m, -2000.0, 2000.0,
        "middle of the obstacle: x ahead, y to the left, z up");
  visit("rotation_rad", obstacle.rotation_rad, -6.3, 6.3,
        "roll, pitch and yaw of the obstacle's axes, turned in that order about the world's axes");
  visit("size_m", obstacle.size_m, 0.02, 400.0,
        "Extent along the obstacle's own axes. A capsule is as long as z and as thick as x and y, which must "
        "be equal; a sphere's three numbers must be equal.");
  visit("texture", obstacle.texture, obstacle_texture_names, "picture on its surface");
}

void visit_fields(FieldVisitor& visit, GoalpostsConfig& config) {
  visit("ahead_m", config.ahead_m, 5.0, 500.0,
        "x of the near upright, the one that the course (y = 0) passes closest to");
  visit("width_m", config.width_m, 1.0, 50.0, "clear width between the two uprights");
  visit("turn_rad", config.turn_rad, 0.0, 1.5,
        "Angle by which the goal is turned so that its far upright stands farther ahead; 0: square to the "
        "course. At 0 the far upright would be outside the cameras' view at the detection depth (our choice; "
        "the paper gives no angle).");
  visit("height_m", config.height_m, 1.0, 50.0, "height of the uprights");
  visit("crossbar_top_m", config.crossbar_top_m, 0.2, 20.0, "height of the crossbar's upper edge");
  visit("radius_m", config.radius_m, 0.01, 1.0,
        "radius of uprights and crossbar; a real crossbar is 6 5/8 in wide");
  visit("pass_minimum_m", config.pass_minimum_m, 0.0, 20.0,
        "smallest distance that the seed may draw from the course (y = 0) to the near upright's surface");
  visit("pass_maximum_m", config.pass_maximum_m, 0.0, 20.0,
        "largest distance that the seed may draw from the course (y = 0) to the near upright's surface");
}

void visit_fields(FieldVisitor& visit, WindowsConfig& config) {
  visit("behind_goal_m", config.behind_goal_m, 1.0, 300.0,
        "distance from the goal plane to the facade behind it; flights end at the goal plane");
  visit("width_m", config.width_m, 1.2, 400.0, "width of the facade");
  visit("height_m", config.height_m, 1.0, 100.0, "height of the facade");
}

void visit_fields(FieldVisitor& visit, FenceConfig& config) {
  visit("height_m", config.height_m, 0.5, 20.0, "height of the palings");
  visit("spacing_m", config.spacing_m, 0.1, 10.0, "distance between the axes of neighbouring palings");
  visit("paling_radius_m", config.paling_radius_m, 0.01, 0.5, "radius of a paling");
  visit("rail_radius_m", config.rail_radius_m, 0.01, 0.5, "radius of a rail that carries palings");
  visit("beside_m", config.beside_m, -100.0, 100.0, "y of the fence that runs along the course");
  visit("first_across_m", config.first_across_m, 1.0, 1000.0, "x of the first fence across the course");
  visit("across_apart_m", config.across_apart_m, 5.0, 1000.0,
        "distance between successive fences across the course; the last stands before the goal");
  visit("reach_m", config.reach_m, 2.0, 100.0,
        "distance from y = 0 to each end of the fences across the course");
  visit("opening_m", config.opening_m, 0.5, 4.0,
        "width of the opening in the fences across the course, at y = 0");
}

}  // namespace understory
