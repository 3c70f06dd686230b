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

class FieldVisitor;

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

void visit_fields(FieldVisitor& visit, ForestConfig& config);

/// The obstacles of a course. `known` may have measured values of each tree of a forest, in order.
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

/// An obstacle of a scenario's own list. It stands on any course in addition to the course's own obstacles.
struct ListedObstacle {
  std::string name = "obstacle";
  ListedShape shape = ListedShape::box;
  Eigen::Vector3d position_m{20, 0, 4};
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m{0.3, 0.3, 8};
  ObstacleTexture texture = ObstacleTexture::bark;
};

void visit_fields(FieldVisitor& visit, ListedObstacle& obstacle);

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

void visit_fields(FieldVisitor& visit, GoalpostsConfig& config);

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

void visit_fields(FieldVisitor& visit, WindowsConfig& config);

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

void visit_fields(FieldVisitor& visit, FenceConfig& config);

/// All palings (kind post) and rails, fence by fence.
std::vector<Obstacle> fence(const FenceConfig& config, double goal_x_m);

}  // namespace understory
