#include "scenarios/recording/walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/recording/carried_path.hpp"

namespace understory {
namespace {

constexpr double shoulder_room_m = 0.5;  // between the lane and the next trunk
constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180;

double room_beside(const Segment& lane, const std::vector<Obstacle>& obstacles) {
  double room_m = std::numeric_limits<double>::infinity();
  for (const Obstacle& bar : obstacles) room_m = std::min(room_m, obstacle_distance_m(lane, bar));
  return room_m;
}

Eigen::Isometry3d pose_at(const WalkPath& path, double t_s) {
  const double speed_mps = path.config.speed_mps;
  const double step_hz = 1.8 * speed_mps / 1.4;  // the length of a step stays the same
  const auto swing = [&](double hz, std::size_t phase) {
    return std::sin(2 * pi * hz * t_s + path.phases_rad[phase]);
  };
  const Eigen::Vector3d position_world(path.from_x_m + speed_mps * t_s,
                                       path.lane_y_m + 0.025 * swing(step_hz / 2, 1),
                                       path.config.height_m + 0.02 * swing(step_hz, 0));
  const double yaw_rad = degree * swing(step_hz / 2, 2) + 2 * degree * swing(0.1, 3);
  const double pitch_rad = path.pitch_rad + 0.6 * degree * swing(step_hz, 0);
  const double roll_rad = degree * swing(step_hz / 2, 1);
  return Eigen::Translation3d(position_world) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

}  // namespace

WalkPath walk_path(const WalkConfig& config, const Scenario& scenario, const StereoRig& rig,
                   const std::vector<Obstacle>& obstacles) {
  constexpr double before_m = 10, lane_step_m = 0.1;
  WalkPath path;
  path.config = config;
  path.gravity_mps2 = scenario.airframe.gravity_mps2;
  double first_x_m = before_m;
  if (!obstacles.empty()) {
    first_x_m = std::numeric_limits<double>::infinity();
    for (const Obstacle& bar : obstacles)
      first_x_m = std::min({first_x_m, bar.from_world.x(), bar.to_world.x()});
  }
  path.from_x_m = std::clamp(first_x_m - before_m, 0.0, scenario.goal_x_m() - 1);
  const Eigen::Vector3d gaze_body = rig.T_body_camera.linear().col(2);
  path.pitch_rad = std::atan2(gaze_body.z(), gaze_body.x());  // positive about y lowers the nose

  const auto lane_is_free = [&](double y_m) {
    return room_beside({{path.from_x_m, y_m, config.height_m}, {scenario.goal_x_m(), y_m, config.height_m}},
                       obstacles) >= shoulder_room_m;
  };
  const int lanes = static_cast<int>(scenario.forest.half_width_m / lane_step_m);
  bool found = false;
  for (int lane = 0; lane <= 2 * lanes && !found; ++lane) {  // 0, 1 left, 1 right, 2 left ...
    const int steps_left = lane % 2 == 1 ? (lane + 1) / 2 : -(lane / 2);
    path.lane_y_m = lane_step_m * steps_left;
    found = lane_is_free(path.lane_y_m);
  }
  if (!found)
    throw ScenarioError(fmt::format(
        "--walk: expected a straight lane with {} m to every obstacle, found none in {} with seed {}",
        shoulder_room_m, scenario.name, scenario.seed));
  std::mt19937_64 generator(seed_for(scenario.seed, "walk"));
  for (double& phase_rad : path.phases_rad)
    phase_rad = 2 * pi * static_cast<double>(generator() >> 11) / 9007199254740992.0;  // 2^53
  return path;
}

Truth walk_truth(const WalkPath& path, std::int64_t t_ns) {
  return carried_truth([&](double t_s) { return pose_at(path, t_s); }, t_ns, path.gravity_mps2);
}

}  // namespace understory
