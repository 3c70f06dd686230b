#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "perception/stereo_rig.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// The cameras carried past obstacles, as the paper's ground data were taken.
struct WalkConfig {
  double speed_mps = 1.4;  ///< a pedestrian's (Bohannon 1997: 1.27 to 1.46), 0.1 .. 5
  double height_m = 1.7;   ///< of the body's origin: shoulders or eyes, 0.3 .. 8
};

/// A straight level line along world x, and the sway about it.
struct WalkPath {
  WalkConfig config;
  double from_x_m = 0;
  double lane_y_m = 0;
  double pitch_rad = 0;  ///< about body y, so that the cameras look level
  double gravity_mps2 = 9.81;
  std::array<double, 4> phases_rad = {};  ///< of the sways
};

/// Along the lane nearest to the middle that keeps shoulders clear of all obstacles, from 10 m before the
/// first of them. The sway's phases come from the scenario's seed. Throws ScenarioError where no lane within
/// the course is free.
WalkPath walk_path(const WalkConfig& config, const Scenario& scenario, const StereoRig& rig,
                   const std::vector<Obstacle>& obstacles);

/// The walking body at t_ns (from 0): pose, and from it by central differences velocity, rates and specific
/// force. Sway with every step (1.8 Hz at 1.4 m/s): 2 cm up and down, 0.6 deg of pitch. With every second
/// step: 2.5 cm from side to side, 1 deg of roll and yaw. Also a slow yaw of 2 deg.
Truth walk_truth(const WalkPath& path, std::int64_t t_ns);

}  // namespace understory
