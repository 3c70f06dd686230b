#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene/obstacle.hpp"

namespace understory {

/// A forest in the launch frame: x ahead, y to the left. Its length also sets the goal plane of every other
/// course.
struct ForestConfig {
  /// mean ground area per tree; 49 m^2: 204 trees per hectare, one per 7 m x 7 m
  double square_metres_per_tree = 49;
  double radius_min_m = 0.10;  ///< smallest trunk radius; radii are drawn uniformly up to forest.radius_max_m
  double radius_max_m = 0.25;  ///< largest radius of a trunk
  double clear_m = 15;         ///< x at which the forest begins; the launch is at x = 0
  /// length of the forest; the goal of every course is the plane x = clear_m + length_m
  double length_m = 60;
  /// half the width of the forest; on every course, a flight that strays farther to the side ends
  double half_width_m = 25;
  /// height of the trunks; the default is above the altitude band, so that no flight passes over them
  double trunk_height_m = 9;
  bool invisible = false;  ///< hides the obstacles of any course from the cameras; they still collide
  /// lets the aircraft pass through the obstacles of any course; they are still drawn
  bool intangible = false;
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
