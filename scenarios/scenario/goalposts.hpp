#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene/obstacle.hpp"

namespace understory {

/// The paper's field goal (Barry & Tedrake 2015 flew past one). Dimensions: NCAA Football Rule 1-2-5:
/// uprights 18 ft 6 in apart inside, at least 30 ft above the ground; top of the crossbar 10 ft above the
/// ground.
struct GoalpostsConfig {
  double ahead_m = 35;     ///< x of the near upright
  double width_m = 5.639;  ///< between the insides of the uprights
  /// Angle of the goal's plane; 0 is straight across the course. The far upright stands farther ahead. At 0
  /// it would pass outside the cameras' view at the detection depth (our choice; the paper gives no angle).
  double turn_rad = 0.7;
  double height_m = 9.144;  ///< top of the uprights
  double crossbar_top_m = 3.048;
  double radius_m = 0.084;  ///< of every bar; a crossbar is 6 5/8 in wide
  double pass_minimum_m =
      0.5;  ///< the seed draws how far beside the course the near upright's surface stands
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

}  // namespace understory
