#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/scene/obstacle.hpp"
#include "sim/scene/trees.hpp"

namespace understory {

enum class StemModel { uniform, inventory };
inline constexpr std::array<std::pair<std::string_view, StemModel>, 2> stem_model_names{
    {{"uniform", StemModel::uniform}, {"inventory", StemModel::inventory}}};

/// A forest in the launch frame: x ahead, y to the left. Its length also sets the goal plane of every other
/// course.
struct ForestConfig {
  double square_metres_per_tree = 49;
  StemModel stems = StemModel::uniform;
  double radius_min_m = 0.10;
  double radius_max_m = 0.25;
  double clear_m = 15;
  double length_m = 60;
  double half_width_m = 25;
  double trunk_height_m = 9;
  std::string trees_file = {};
  double thinnest_stem_m = 0.10;
  std::optional<double> file_x_m = {};
  std::optional<double> file_y_m = {};
  std::optional<double> file_heading_rad = {};
  bool invisible = false;
  bool intangible = false;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ForestConfig& config) {
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
        "half the width of the forest; on every course, a flight that strays farther to the side ends");
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

/// The obstacles of a course. Of a forest's trunks it may say what is known of each tree, in their order.
struct Planted {
  std::vector<Obstacle> obstacles;
  std::vector<KnownTree> known = {};
};

/// A random forest. With stems `uniform` a Poisson forest: the number of trees is Poisson with mean area /
/// square_metres_per_tree, each tree uniform over the forest's rectangle, independent of the others; trunks
/// may therefore overlap, as in the theory of flight through Poisson forests (Karaman & Frazzoli 2012).
/// Sorted by x. The generator is the forest's own, from `seed`.
std::vector<Obstacle> random_forest(const ForestConfig& config, std::uint64_t seed);

enum class ListedShape { box, capsule, sphere };
inline constexpr std::array<std::pair<std::string_view, ListedShape>, 3> listed_shape_names{
    {{"box", ListedShape::box}, {"capsule", ListedShape::capsule}, {"sphere", ListedShape::sphere}}};
inline constexpr std::array<std::pair<std::string_view, ObstacleTexture>, 3> obstacle_texture_names{
    {{"bark", ObstacleTexture::bark},
     {"windows", ObstacleTexture::windows},
     {"litter", ObstacleTexture::litter}}};

/// An obstacle of a scenario's own list. It stands on any course beside what the course has.
struct ListedObstacle {
  std::string name = "obstacle";
  ListedShape shape = ListedShape::box;
  Eigen::Vector3d position_m{20, 0, 4};
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m{0.3, 0.3, 8};
  ObstacleTexture texture = ObstacleTexture::bark;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ListedObstacle& obstacle) {
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

/// The obstacle as it stands in the world.
Obstacle placed(const ListedObstacle& listed);

/// The paper's field goal (Barry & Tedrake 2015 flew past one). Dimensions: NCAA Football Rule 1-2-5:
/// uprights 18 ft 6 in apart inside, at least 30 ft above the ground; top of the crossbar 10 ft above the
/// ground.
struct GoalpostsConfig {
  double ahead_m = 35;
  double width_m = 5.639;
  double turn_rad = 0.7;
  double height_m = 9.144;
  double crossbar_top_m = 3.048;
  double radius_m = 0.084;
  double pass_minimum_m = 0.5;
  double pass_maximum_m = 2.0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, GoalpostsConfig& config) {
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

/// Two uprights from the ground and a crossbar between them. The course (y = 0) runs between the uprights;
/// the near one, left or right by the seed, is pass_minimum_m .. pass_maximum_m from it.
std::vector<Obstacle> goalposts(const GoalpostsConfig& config, std::uint64_t seed);

/// A facade of equal windows across the way behind the goal (sim/scene/meshes.hpp): repeated texture, which
/// misled the paper's detector without its invariance filter (docs/sources.md [1]).
struct WindowsConfig {
  double behind_goal_m = 12;
  double width_m = 60;
  double height_m = 20;
};

template <typename Visitor>
void visit_fields(Visitor& visit, WindowsConfig& config) {
  visit("behind_goal_m", config.behind_goal_m, 1.0, 300.0,
        "distance from the goal plane to the facade behind it; flights end at the goal plane");
  visit("width_m", config.width_m, 1.2, 400.0, "width of the facade");
  visit("height_m", config.height_m, 1.0, 100.0, "height of the facade");
}

/// The one wall, its middle on y = 0.
std::vector<Obstacle> windows(const WindowsConfig& config, double goal_x_m);

/// Fences of equal round palings on two rails, lower than the flight. One runs beside the course, others
/// stand across it with a gate at y = 0. At a certain distance the neighbour of a paling lies at the
/// disparity that the detector searches: with the long rig and 0.4 m between palings at 22 m instead of 10.
struct FenceConfig {
  double height_m = 2;
  double spacing_m = 0.4;
  double paling_radius_m = 0.05;
  double rail_radius_m = 0.04;
  double beside_m = 3.5;
  double first_across_m = 30;
  double across_apart_m = 25;
  double reach_m = 15;
  double opening_m = 3;
};

template <typename Visitor>
void visit_fields(Visitor& visit, FenceConfig& config) {
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

/// All palings (kind post) and rails, fence by fence.
std::vector<Obstacle> fence(const FenceConfig& config, double goal_x_m);

}  // namespace understory
