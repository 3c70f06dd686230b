#pragma once

#include <vector>

#include "sim/scene/obstacle.hpp"

namespace understory {

/// Fences of equal round palings on two rails, lower than the flight. One runs beside the course, others
/// stand across it with a gate at y = 0. At a certain distance the neighbour of a paling lies at the
/// disparity that the detector searches: with the long rig and 0.4 m between palings at 22 m instead of 10.
struct FenceConfig {
  double height_m = 2;     ///< of the palings
  double spacing_m = 0.4;  ///< from one paling's axis to the next
  double paling_radius_m = 0.05;
  double rail_radius_m = 0.04;
  double beside_m = 3.5;       ///< y of the one along the course, from the first across to the goal
  double first_across_m = 30;  ///< x of the first across
  double across_apart_m = 25;  ///< and from it to the next, up to the goal
  double reach_m = 15;         ///< those across end at this |y|
  double gate_m = 3;           ///< the gap in them
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
  visit("gate_m", config.gate_m, 0.5, 4.0);
}

/// All palings (kind post) and rails, fence by fence.
std::vector<Obstacle> fence(const FenceConfig& config, double goal_x_m);

}  // namespace understory
