#include "scenarios/flight/oracles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/assertion.hpp"

namespace understory {
namespace {

constexpr int block_px = 5;
constexpr int last_row_of_240 = 205;  // about where the original detector ends (docs/sources.md [2])
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A round obstacle in the left camera's frame.
struct SeenObstacle {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

}  // namespace

void TruthHistory::observe(const Truth& truth) {
  moments_.push_back(truth);
  while (moments_.front().t_ns + 600'000'000 < truth.t_ns) moments_.pop_front();
}

const Truth& TruthHistory::at(std::int64_t t_ns) const {
  assert_always(!moments_.empty(), "a truth was observed before it is asked for");
  const auto later = std::upper_bound(moments_.begin(), moments_.end(), t_ns,
                                      [](std::int64_t t, const Truth& truth) { return t < truth.t_ns; });
  return later == moments_.begin() ? *later : *std::prev(later);
}

State state_of(const Truth& truth) {
  State state;
  state.t_ns = truth.t_ns;
  state.T_world_body = truth.T_world_body;
  state.altitude_m = truth.T_world_body.translation().z();
  state.velocity_body_mps = truth.T_world_body.linear().transpose() * truth.velocity_world_mps;
  state.angular_rate_body_radps = truth.angular_rate_body_radps;
  state.specific_force_body_mps2 = truth.specific_force_body_mps2;
  return state;
}

void TrueState::on(const ImuSample& sample) {
  State next = state_of(history_.at(sample.t_ns));
  const double elapsed_s = state_.t_ns == 0 ? 0 : static_cast<double>(next.t_ns - state_.t_ns) * 1e-9;
  next.distance_flown_m = state_.distance_flown_m + elapsed_s * next.velocity_body_mps.norm();
  state_ = next;
}

State TrueState::state_at(std::int64_t t_ns) const {
  State then = state_of(history_.at(t_ns));
  const double since_s = static_cast<double>(state_.t_ns - then.t_ns) * 1e-9;
  then.distance_flown_m = state_.distance_flown_m - since_s * state_.velocity_body_mps.norm();
  return then;
}

double ray_meets_round_obstacle(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m) {
  const double length_m = (to - from).norm();
  const Eigen::Vector3d axis = (to - from) / length_m;
  const Eigen::Vector3d offset = origin - from;
  const double offset_along = offset.dot(axis);
  const double direction_along = direction.dot(axis);
  const Eigen::Vector3d offset_across = offset - offset_along * axis;
  const Eigen::Vector3d direction_across = direction - direction_along * axis;
  const double a = direction_across.squaredNorm();
  const double b = offset_across.dot(direction_across);
  const double c = offset_across.squaredNorm() - radius_m * radius_m;
  const double discriminant = b * b - a * c;
  if (a < 1e-15 || discriminant < 0) return infinity;
  const double multiple = (-b - std::sqrt(discriminant)) / a;
  const double along = offset_along + multiple * direction_along;
  return multiple > 0 && along >= 0 && along <= length_m ? multiple : infinity;
}

double ray_meets_wall(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                      const Obstacle& wall) {
  const Eigen::Vector3d extent = wall.to_world - wall.from_world;
  Eigen::Matrix3d R_wall_world;
  R_wall_world.row(0) = Eigen::Vector3d(extent.x(), extent.y(), 0).normalized();
  R_wall_world.row(2) = Eigen::Vector3d::UnitZ();
  R_wall_world.row(1) = R_wall_world.row(2).cross(R_wall_world.row(0));
  const Eigen::Vector3d half(0.5 * extent.head<2>().norm(), wall.radius_m, 0.5 * std::abs(extent.z()));
  const Eigen::Vector3d from = R_wall_world * (origin_world - 0.5 * (wall.from_world + wall.to_world));
  const Eigen::Vector3d direction = R_wall_world * direction_world;
  double enters = 0, leaves = infinity;  // the three pairs of faces, one after the other
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0 && std::abs(from[axis]) > half[axis]) return infinity;
    if (direction[axis] == 0) continue;
    const double reach = half[axis] / std::abs(direction[axis]), middle = -from[axis] / direction[axis];
    enters = std::max(enters, middle - reach);
    leaves = std::min(leaves, middle + reach);
  }
  return enters > 0 && enters < leaves ? enters : infinity;
}

TrueDepth::TrueDepth(const StereoRig& rig, std::vector<Obstacle> obstacles, const TruthHistory& history)
    : rig_(rig), obstacles_(std::move(obstacles)), history_(history) {
  interval_ = rig.depths_around(std::round(rig.disparity_px(rig.detection_depth_m)));
}

const std::vector<StereoHit>& TrueDepth::detect(const StereoFrame& frame) {
  const Eigen::Isometry3d T_camera_world =
      (history_.at(frame.t_ns).T_world_body * rig_.T_body_camera).inverse();
  const double corner_x =
      std::max(rig_.center_left_x_px, rig_.width_px - rig_.center_left_x_px) / rig_.focal_px;
  const double corner_y = std::max(rig_.center_y_px, rig_.height_px - rig_.center_y_px) / rig_.focal_px;
  const double reach_m = interval_.far_m * std::sqrt(1 + corner_x * corner_x + corner_y * corner_y);
  const Eigen::Isometry3d T_world_camera = T_camera_world.inverse();
  std::vector<SeenObstacle> round_obstacles;
  std::vector<Obstacle> walls;
  for (const Obstacle& obstacle : obstacles_) {
    if (obstacle.kind == ObstacleKind::wall) {
      walls.push_back(obstacle);
      continue;
    }
    const SeenObstacle seen{T_camera_world * obstacle.from_world, T_camera_world * obstacle.to_world,
                            obstacle.radius_m};
    const Eigen::Vector3d along = seen.to - seen.from;
    const double nearest = std::clamp(-seen.from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const bool is_ahead = std::max(seen.from.z(), seen.to.z()) + obstacle.radius_m > 0;
    if (is_ahead && (seen.from + nearest * along).norm() < reach_m + obstacle.radius_m)
      round_obstacles.push_back(seen);
  }
  hits_.clear();
  if (round_obstacles.empty() && walls.empty()) return hits_;
  const int last_row_px = rig_.scaled_row_px(last_row_of_240);
  for (int row = 0; row <= last_row_px && row + block_px <= rig_.height_px; row += block_px) {
    for (int column = 0; column + block_px <= rig_.width_px; column += block_px) {
      const Eigen::Vector3d ray((column + 2 - rig_.center_left_x_px) / rig_.focal_px,
                                (row + 2 - rig_.center_y_px) / rig_.focal_px, 1);
      double depth_m = infinity;  // the ray's z is 1, so multiples of it are depths
      for (const SeenObstacle& obstacle : round_obstacles) {
        depth_m = std::min(depth_m, ray_meets_round_obstacle(Eigen::Vector3d::Zero(), ray, obstacle.from,
                                                             obstacle.to, obstacle.radius_m));
      }
      for (const Obstacle& wall : walls) {
        depth_m = std::min(depth_m,
                           ray_meets_wall(T_world_camera.translation(), T_world_camera.linear() * ray, wall));
      }
      if (depth_m < interval_.near_m || depth_m > interval_.far_m || depth_m == infinity) continue;
      hits_.push_back({depth_m * ray, column, row, rig_.disparity_px(depth_m), 0.0, 0.0, {}});
    }
  }
  return hits_;
}

}  // namespace understory
