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
  /// mean ground area per tree; 49 m^2: 204 trees per hectare, one per 7 m x 7 m
  double square_metres_per_tree = 49;
  /// How the seed draws a random forest's stems. uniform: radii evenly between forest.radius_min_m and
  /// radius_max_m, places independent; inventory: radii within the same limits and clusters of thin stems as
  /// in a measured forest (docs/woods.md)
  StemModel stems = StemModel::uniform;
  double radius_min_m = 0.10;  ///< smallest trunk radius; radii are drawn uniformly up to forest.radius_max_m
  double radius_max_m = 0.25;  ///< largest radius of a trunk
  double clear_m = 15;         ///< x at which the forest begins; the launch is at x = 0
  /// length of the forest; the goal of every course is the plane x = clear_m + length_m
  double length_m = 60;
  /// half the width of the forest; on every course, a flight that strays farther to the side ends
  double half_width_m = 25;
  /// height of the trunks; the default is above the altitude band, so that no flight passes over them
  double trunk_height_m = 9;
  /// CSV file of measured stems that stand instead of random ones (docs/woods.md describes it). A relative
  /// path is looked for beside the scenario file, then in the folder that the environment variable
  /// UNDERSTORY_DATA names. Empty: random trees
  std::string trees_file = {};
  double thinnest_stem_m = 0.10;  ///< diameter below which a stem of forest.trees_file is left out
  /// x coordinate of the launch in forest.trees_file; empty: drawn from the seed so that the course lies
  /// among the stems
  std::optional<double> file_x_m = {};
  std::optional<double> file_y_m = {};  ///< y coordinate of the launch in forest.trees_file; empty: drawn
  /// direction of the flight in forest.trees_file, counter-clockwise from its x axis; empty: drawn
  std::optional<double> file_heading_rad = {};
  bool invisible = false;  ///< hides the obstacles of any course from the cameras; they still collide
  /// lets the aircraft pass through the obstacles of any course; they are still drawn
  bool intangible = false;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ForestConfig& config) {
  visit("square_metres_per_tree", config.square_metres_per_tree, 4.0, 100000.0);
  visit("stems", config.stems, stem_model_names);
  visit("radius_min_m", config.radius_min_m, 0.01, 2.0);
  visit("radius_max_m", config.radius_max_m, 0.01, 2.0);
  visit("clear_m", config.clear_m, 0.0, 1000.0);
  visit("length_m", config.length_m, 1.0, 1000.0);
  visit("half_width_m", config.half_width_m, 1.0, 200.0);
  visit("trunk_height_m", config.trunk_height_m, 1.0, 60.0);
  visit("trees_file", config.trees_file);
  visit("thinnest_stem_m", config.thinnest_stem_m, 0.001, 5.0);
  visit("file_x_m", config.file_x_m, -1e7, 1e7);
  visit("file_y_m", config.file_y_m, -1e7, 1e7);
  visit("file_heading_rad", config.file_heading_rad, -6.3, 6.3);
  visit("invisible", config.invisible);
  visit("intangible", config.intangible);
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
  std::string name = "obstacle";         ///< name in results, unique in the list
  ListedShape shape = ListedShape::box;  ///< shape of the obstacle
  Eigen::Vector3d position_m{20, 0, 4};  ///< middle of the obstacle: x ahead, y to the left, z up
  /// roll, pitch and yaw of the obstacle's axes, turned in that order about the world's axes
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  /// Extent along the obstacle's own axes. A capsule is as long as z and as thick as x and y, which must be
  /// equal; a sphere's three numbers must be equal.
  Eigen::Vector3d size_m{0.3, 0.3, 8};
  ObstacleTexture texture = ObstacleTexture::bark;  ///< picture on its surface
};

template <typename Visitor>
void visit_fields(Visitor& visit, ListedObstacle& obstacle) {
  visit("name", obstacle.name);
  visit("shape", obstacle.shape, listed_shape_names);
  visit("position_m", obstacle.position_m, -2000.0, 2000.0);
  visit("rotation_rad", obstacle.rotation_rad, -6.3, 6.3);
  visit("size_m", obstacle.size_m, 0.02, 400.0);
  visit("texture", obstacle.texture, obstacle_texture_names);
}

/// The obstacle as it stands in the world.
Obstacle placed(const ListedObstacle& listed);

/// The paper's field goal (Barry & Tedrake 2015 flew past one). Dimensions: NCAA Football Rule 1-2-5:
/// uprights 18 ft 6 in apart inside, at least 30 ft above the ground; top of the crossbar 10 ft above the
/// ground.
struct GoalpostsConfig {
  double ahead_m = 35;     ///< x of the near upright, the one that the course (y = 0) passes closest to
  double width_m = 5.639;  ///< clear width between the two uprights
  /// Angle by which the goal is turned so that its far upright stands farther ahead; 0: square to the course.
  /// At 0 the far upright would be outside the cameras' view at the detection depth (our choice; the paper
  /// gives no angle).
  double turn_rad = 0.7;
  double height_m = 9.144;        ///< height of the uprights
  double crossbar_top_m = 3.048;  ///< height of the crossbar's upper edge
  double radius_m = 0.084;        ///< radius of uprights and crossbar; a real crossbar is 6 5/8 in wide
  /// smallest distance that the seed may draw from the course (y = 0) to the near upright's surface
  double pass_minimum_m = 0.5;
  /// largest distance that the seed may draw from the course (y = 0) to the near upright's surface
  double pass_maximum_m = 2.0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, GoalpostsConfig& config) {
  visit("ahead_m", config.ahead_m, 5.0, 500.0);
  visit("width_m", config.width_m, 1.0, 50.0);
  visit("turn_rad", config.turn_rad, 0.0, 1.5);
  visit("height_m", config.height_m, 1.0, 50.0);
  visit("crossbar_top_m", config.crossbar_top_m, 0.2, 20.0);
  visit("radius_m", config.radius_m, 0.01, 1.0);
  visit("pass_minimum_m", config.pass_minimum_m, 0.0, 20.0);
  visit("pass_maximum_m", config.pass_maximum_m, 0.0, 20.0);
}

/// Two uprights from the ground and a crossbar between them. The course (y = 0) runs between the uprights;
/// the near one, left or right by the seed, is pass_minimum_m .. pass_maximum_m from it.
std::vector<Obstacle> goalposts(const GoalpostsConfig& config, std::uint64_t seed);

/// A facade of equal windows across the way behind the goal (sim/scene/meshes.hpp): repeated texture, which
/// misled the paper's detector without its invariance filter (docs/sources.md [1]).
struct WindowsConfig {
  /// distance from the goal plane to the facade behind it; flights end at the goal plane
  double behind_goal_m = 12;
  double width_m = 60;   ///< width of the facade
  double height_m = 20;  ///< height of the facade
};

template <typename Visitor>
void visit_fields(Visitor& visit, WindowsConfig& config) {
  visit("behind_goal_m", config.behind_goal_m, 1.0, 300.0);
  visit("width_m", config.width_m, 1.2, 400.0);
  visit("height_m", config.height_m, 1.0, 100.0);
}

/// The one wall, its middle on y = 0.
std::vector<Obstacle> windows(const WindowsConfig& config, double goal_x_m);

/// Fences of equal round palings on two rails, lower than the flight. One runs beside the course, others
/// stand across it with a gate at y = 0. At a certain distance the neighbour of a paling lies at the
/// disparity that the detector searches: with the long rig and 0.4 m between palings at 22 m instead of 10.
struct FenceConfig {
  double height_m = 2;            ///< height of the palings
  double spacing_m = 0.4;         ///< distance between the axes of neighbouring palings
  double paling_radius_m = 0.05;  ///< radius of a paling
  double rail_radius_m = 0.04;    ///< radius of a rail that carries palings
  double beside_m = 3.5;          ///< y of the fence that runs along the course
  double first_across_m = 30;     ///< x of the first fence across the course
  /// distance between successive fences across the course; the last stands before the goal
  double across_apart_m = 25;
  double reach_m = 15;   ///< distance from y = 0 to each end of the fences across the course
  double opening_m = 3;  ///< width of the opening in the fences across the course, at y = 0
};

template <typename Visitor>
void visit_fields(Visitor& visit, FenceConfig& config) {
  visit("height_m", config.height_m, 0.5, 20.0);
  visit("spacing_m", config.spacing_m, 0.1, 10.0);
  visit("paling_radius_m", config.paling_radius_m, 0.01, 0.5);
  visit("rail_radius_m", config.rail_radius_m, 0.01, 0.5);
  visit("beside_m", config.beside_m, -100.0, 100.0);
  visit("first_across_m", config.first_across_m, 1.0, 1000.0);
  visit("across_apart_m", config.across_apart_m, 5.0, 1000.0);
  visit("reach_m", config.reach_m, 2.0, 100.0);
  visit("opening_m", config.opening_m, 0.5, 4.0);
}

/// All palings (kind post) and rails, fence by fence.
std::vector<Obstacle> fence(const FenceConfig& config, double goal_x_m);

}  // namespace understory
