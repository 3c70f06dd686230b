#pragma once

#include <vector>

#include "sim/scene/obstacle.hpp"

namespace understory {

/// A facade of equal windows across the way behind the goal (sim/scene/facade.hpp): repeated texture, which
/// misled the paper's detector without its invariance filter (docs/sources.md [1]).
struct WindowsConfig {
  double behind_goal_m = 12;  ///< from the goal plane to its face; flights end before it
  double width_m = 60;
  double height_m = 20;
};

template <typename Visitor>
void visit_fields(Visitor& visit, WindowsConfig& config) {
  visit("behind_goal_m", config.behind_goal_m, 1.0, 300.0);
  visit("width_m", config.width_m, 1.2, 400.0);
  visit("height_m", config.height_m, 1.0, 100.0);
}

/// The one wall, its middle on y = 0.
std::vector<Obstacle> windows(const WindowsConfig& config, double goal_x_m);

}  // namespace understory
