#include "scenarios/parts/oracles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/assertion.hpp"

namespace understory {
namespace {

constexpr int block_px = 5;
constexpr int last_row_of_240 = 205;  // about where the original detector ends (docs/sources.md [2])
constexpr double infinity = std::numeric_limits<double>::infinity();

/// From the outside of a box about the origin.
double ray_meets_box(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                     const Eigen::Vector3d& half_m) {
  double enters = 0, leaves = infinity;  // the three pairs of faces, one after the other
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0 && std::abs(from[axis]) > half_m[axis]) return infinity;
    if (direction[axis] == 0) continue;
    const double reach = half_m[axis] / std::abs(direction[axis]), middle = -from[axis] / direction[axis];
    enters = std::max(enters, middle - reach);
    leaves = std::min(leaves, middle + reach);
  }
  return enters > 0 && enters < leaves ? enters : infinity;
}

double ray_meets_sphere(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                        const Eigen::Vector3d& centre, double radius_m) {
  const Eigen::Vector3d offset = origin - centre;
  const double a = direction.squaredNorm(), b = offset.dot(direction);
  const double c = offset.squaredNorm() - radius_m * radius_m, discriminant = b * b - a * c;
  if (c < 0 || discriminant < 0) return infinity;
  const double multiple = (-b - std::sqrt(discriminant)) / a;
  return multiple > 0 ? multiple : infinity;
}

/// Pixels between which a ball in the camera's frame can be seen along one axis, a little wide; all where the
/// camera may be inside or beside it.
void extend_by_ball(double across_m, double depth_m, double radius_m, double focal_px, double centre_px,
                    double& low_px, double& high_px) {
  const double range_m = std::hypot(across_m, depth_m);
  const double direction = std::atan2(across_m, depth_m),
               half = range_m > radius_m ? std::asin(radius_m / range_m) : 4;
  constexpr double quarter_turn = 1.55;
  const auto pixel = [&](double angle) {
    if (angle <= -quarter_turn) return -infinity;
    return angle >= quarter_turn ? infinity : centre_px + focal_px * std::tan(angle);
  };
  low_px = std::min(low_px, pixel(direction - half) - 1);
  high_px = std::max(high_px, pixel(direction + half) + 1);
}

/// Rows and columns of blocks.
struct Blocks {
  int first_row, end_row, first_column, end_column;
};

/// `seen` in the camera's frame. All blocks where it reaches behind the camera: between an end before it and
/// one behind it lies every direction on one side.
Blocks blocks_that_may_show(const Obstacle& seen, const StereoRig& rig, int rows, int columns) {
  if (std::min(seen.from_world.z(), seen.to_world.z()) <= 0) return {0, rows, 0, columns};
  double left_px = infinity, right_px = -infinity, top_px = infinity, bottom_px = -infinity;
  for (const Eigen::Vector3d& end : {seen.from_world, seen.to_world}) {
    extend_by_ball(end.x(), end.z(), seen.radius_m, rig.focal_px, rig.center_left_x_px, left_px, right_px);
    extend_by_ball(end.y(), end.z(), seen.radius_m, rig.focal_px, rig.center_y_px, top_px, bottom_px);
  }
  const auto block = [](double at, int count) { return static_cast<int>(std::clamp(at, 0.0, 1.0 * count)); };
  return {block(top_px / block_px - 1, rows), block(bottom_px / block_px + 1, rows),
          block(left_px / block_px - 1, columns), block(right_px / block_px + 1, columns)};
}

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

void TrueState::on(const Sample& sample) {
  const auto* imu = std::get_if<ImuSample>(&sample);
  if (imu == nullptr) return;
  State next = state_of(history_.at(imu->t_ns));
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
  return ray_meets_box(R_wall_world * (origin_world - 0.5 * (wall.from_world + wall.to_world)),
                       R_wall_world * direction_world, half);
}

double ray_meets(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                 const Obstacle& obstacle) {
  if (obstacle.kind == ObstacleKind::wall) return ray_meets_wall(origin_world, direction_world, obstacle);
  if (obstacle.kind == ObstacleKind::box) {
    const Eigen::Isometry3d T_box_world = obstacle.T_world_box().inverse();
    return ray_meets_box(T_box_world * origin_world, T_box_world.linear() * direction_world,
                         obstacle.half_size_m);
  }
  const Eigen::Vector3d &from = obstacle.from_world, &to = obstacle.to_world;
  double multiple = infinity;
  if (from != to)
    multiple = ray_meets_round_obstacle(origin_world, direction_world, from, to, obstacle.radius_m);
  if (!obstacle.has_round_ends()) return multiple;
  for (const Eigen::Vector3d& end : {from, to})
    multiple = std::min(multiple, ray_meets_sphere(origin_world, direction_world, end, obstacle.radius_m));
  return multiple;
}

std::vector<DepthInterval> intervals_around(const std::vector<double>& depths_m, const StereoRig& rig) {
  std::vector<DepthInterval> intervals;
  for (const double depth_m : depths_m)
    intervals.push_back(rig.depths_around(std::round(rig.disparity_px(depth_m))));
  return intervals;
}

TrueDepth::TrueDepth(const StereoRig& rig, std::vector<Obstacle> obstacles, const TruthHistory& history,
                     std::vector<DepthInterval> intervals)
    : rig_(rig), obstacles_(std::move(obstacles)), history_(history), intervals_(std::move(intervals)) {
  if (intervals_.empty()) intervals_ = intervals_around({rig.detection_depth_m}, rig);
}

const std::vector<StereoHit>& TrueDepth::detect(const StereoFrame& frame) {
  const Eigen::Isometry3d T_world_camera = history_.at(frame.t_ns).T_world_body * rig_.T_body_camera;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  const double corner_x =
      std::max(rig_.center_left_x_px, rig_.width_px - rig_.center_left_x_px) / rig_.focal_px;
  const double corner_y = std::max(rig_.center_y_px, rig_.height_px - rig_.center_y_px) / rig_.focal_px;
  double far_m = 0;
  for (const DepthInterval& interval : intervals_) far_m = std::max(far_m, interval.far_m);
  const double reach_m = far_m * std::sqrt(1 + corner_x * corner_x + corner_y * corner_y);
  const int rows = this->rows(), columns = this->columns();
  nearest_.assign(static_cast<std::size_t>(rows * columns), {infinity, 0});
  for (std::size_t number = 0; number < obstacles_.size(); ++number) {
    const Obstacle& obstacle = obstacles_[number];
    Obstacle seen = obstacle;  // in the camera's frame
    seen.from_world = T_camera_world * obstacle.from_world;
    seen.to_world = T_camera_world * obstacle.to_world;
    seen.turn_world = T_camera_world.linear() * obstacle.turn_world;
    const bool flat = obstacle.kind == ObstacleKind::wall;  // upright in the world alone
    const Eigen::Vector3d along = seen.to_world - seen.from_world;
    const double length2 = std::max(along.squaredNorm(), 1e-12);
    const double nearest = std::clamp(-seen.from_world.dot(along) / length2, 0.0, 1.0);
    const bool is_ahead = std::max(seen.from_world.z(), seen.to_world.z()) + obstacle.radius_m > 0;
    if (!flat && (!is_ahead || (seen.from_world + nearest * along).norm() >= reach_m + obstacle.radius_m))
      continue;
    const Blocks blocks =
        flat ? Blocks{0, rows, 0, columns} : blocks_that_may_show(seen, rig_, rows, columns);
    for (int row = blocks.first_row; row < blocks.end_row; ++row)
      for (int column = blocks.first_column; column < blocks.end_column; ++column) {
        const Eigen::Vector3d ray = ray_of(row, column);
        auto& nearest_so_far = nearest_[static_cast<std::size_t>(row * columns + column)];
        // The ray's z is 1, so multiples of it are depths.
        const double depth_m =
            flat ? ray_meets_wall(T_world_camera.translation(), T_world_camera.linear() * ray, obstacle)
                 : ray_meets(Eigen::Vector3d::Zero(), ray, seen);
        if (depth_m < nearest_so_far.first) nearest_so_far = {depth_m, number};
      }
  }
  hits_.clear();
  obstacles_of_hits_.clear();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const auto [depth_m, number] = nearest_[static_cast<std::size_t>(row * columns + column)];
      const auto holds = [depth_m = depth_m](const DepthInterval& interval) {
        return depth_m >= interval.near_m && depth_m <= interval.far_m;
      };
      if (depth_m == infinity || std::ranges::none_of(intervals_, holds)) continue;
      hits_.push_back(hit_at(row, column, depth_m));
      obstacles_of_hits_.push_back(number);
    }
  return hits_;
}

int TrueDepth::rows() const {
  const int last_row_px = std::min(rig_.scaled_row_px(last_row_of_240), rig_.height_px - block_px);
  return last_row_px < 0 ? 0 : last_row_px / block_px + 1;
}

int TrueDepth::columns() const { return rig_.width_px / block_px; }

StereoHit TrueDepth::hit_at(int row, int column, double depth_m) const {
  return {depth_m * ray_of(row, column), column * block_px, row * block_px, rig_.disparity_px(depth_m)};
}

/// Through the middle of a block, camera frame.
Eigen::Vector3d TrueDepth::ray_of(int row, int column) const {
  return {(column * block_px + 2 - rig_.center_left_x_px) / rig_.focal_px,
          (row * block_px + 2 - rig_.center_y_px) / rig_.focal_px, 1};
}

}  // namespace understory
