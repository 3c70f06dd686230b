#include "scenarios/flight/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace understory {

double segment_distance_m(const Segment& a, const Segment& b) {
  const Eigen::Vector3d along_a = a.to - a.from;
  const Eigen::Vector3d along_b = b.to - b.from;
  const Eigen::Vector3d between = a.from - b.from;
  const double aa = along_a.squaredNorm();
  const double bb = along_b.squaredNorm();
  const double ab = along_a.dot(along_b);
  const double a_between = along_a.dot(between);
  const double b_between = along_b.dot(between);
  constexpr double tiny = 1e-12;
  const double denominator = aa * bb - ab * ab;
  double s = 0;  // along a; where the segments are parallel any s will do
  if (denominator > tiny * aa * bb) s = std::clamp((ab * b_between - a_between * bb) / denominator, 0.0, 1.0);
  double t = bb > tiny ? (ab * s + b_between) / bb : 0;
  if (t < 0 || t > 1 ||
      bb <= tiny) {  // the nearest point of b is an end: take that, then the best point of a
    t = std::clamp(t, 0.0, 1.0);
    s = aa > tiny ? std::clamp((ab * t - a_between) / aa, 0.0, 1.0) : 0;
  }
  return (between + s * along_a - t * along_b).norm();
}

namespace {

/// Distance between a segment and an upright rectangle, given by its diagonal: 0 where the segment passes
/// through it. Otherwise an edge of the rectangle is nearest, or an end of the segment that faces it.
double rectangle_distance_m(const Segment& segment, const Segment& diagonal) {
  const Eigen::Vector3d across = diagonal.to - diagonal.from;
  const Eigen::Vector3d side(across.x(), across.y(), 0), up(0, 0, across.z());
  const Eigen::Vector3d normal = side.cross(up).normalized();
  const Eigen::Vector3d corners[] = {diagonal.from, diagonal.from + side, diagonal.to, diagonal.from + up};
  double minimum = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4; ++i)
    minimum = std::min(minimum, segment_distance_m(segment, {corners[i], corners[(i + 1) % 4]}));
  const auto is_over_face = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d from_corner = point - diagonal.from;
    const double along = from_corner.dot(side) / side.squaredNorm(), height = from_corner.z() / across.z();
    return along >= 0 && along <= 1 && height >= 0 && height <= 1;
  };
  const double a = normal.dot(segment.from - diagonal.from), b = normal.dot(segment.to - diagonal.from);
  if (is_over_face(segment.from)) minimum = std::min(minimum, std::abs(a));
  if (is_over_face(segment.to)) minimum = std::min(minimum, std::abs(b));
  if (a * b < 0 && is_over_face(segment.from + a / (a - b) * (segment.to - segment.from))) return 0;
  return minimum;
}

/// How the aircraft counts, in the world.
std::array<Segment, 2> parts_of(const Eigen::Isometry3d& T_world_body, const Airframe& airframe) {
  const double tail_x = airframe.elevon_hinge_x_m - airframe.elevon_chord_m;
  const double nose_x = tail_x + 2 * airframe.chord_m;
  const double tip_y = airframe.span_m / 2;
  return {
      Segment{T_world_body * Eigen::Vector3d(airframe.winglet_x_m, tip_y, 0),
              T_world_body * Eigen::Vector3d(airframe.winglet_x_m, -tip_y, 0)},
      Segment{T_world_body * Eigen::Vector3d(nose_x, 0, 0), T_world_body * Eigen::Vector3d(tail_x, 0, 0)}};
}

Eigen::AlignedBox3d box_around(const std::array<Segment, 2>& parts) {
  Eigen::AlignedBox3d around;
  for (const Segment& part : parts) around.extend(part.from).extend(part.to);
  return around;
}

/// All within this distance of the obstacle's surface.
Eigen::AlignedBox3d box_around(const Obstacle& obstacle, double within_m) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(obstacle.radius_m + within_m);
  return {obstacle.from_world.cwiseMin(obstacle.to_world) - reach,
          obstacle.from_world.cwiseMax(obstacle.to_world) + reach};
}

constexpr double rounding_m = 1e-9;

/// Lowers `minimum` to the distance from any of the obstacles. The distance of bounding boxes excludes most
/// obstacles of a forest.
void lower(double& minimum, const std::array<Segment, 2>& parts, const Eigen::AlignedBox3d& around,
           const std::vector<Obstacle>& obstacles) {
  for (const Obstacle& obstacle : obstacles) {
    Eigen::AlignedBox3d box(obstacle.from_world.cwiseMin(obstacle.to_world),
                            obstacle.from_world.cwiseMax(obstacle.to_world));
    const double matters_m = minimum + obstacle.radius_m + rounding_m;
    if (matters_m < 0 || around.squaredExteriorDistance(box) > matters_m * matters_m) continue;
    for (const Segment& part : parts) minimum = std::min(minimum, obstacle_distance_m(part, obstacle));
  }
}

}  // namespace

/// The distance from a box is convex along a straight line: golden section finds its least.
double box_distance_m(const Segment& segment, const Eigen::Vector3d& half_size_m) {
  const auto at = [&](double share) {
    const Eigen::Vector3d point = segment.from + share * (segment.to - segment.from);
    return (point.cwiseAbs() - half_size_m).cwiseMax(0).norm();
  };
  constexpr double golden = 0.6180339887498949;
  double low = 0, high = 1, one = 1 - golden, other = golden, at_one = at(one), at_other = at(other);
  for (int i = 0; i < 60; ++i) {
    if (at_one <= at_other) {
      high = other, other = one, at_other = at_one;
      one = high - golden * (high - low), at_one = at(one);
    } else {
      low = one, one = other, at_one = at_other;
      other = low + golden * (high - low), at_other = at(other);
    }
  }
  return std::min({at(0), at(1), at_one, at_other});
}

double obstacle_distance_m(const Segment& segment, const Obstacle& obstacle) {
  if (obstacle.kind == ObstacleKind::box) {
    const Eigen::Isometry3d T_box_world = obstacle.T_world_box().inverse();
    return box_distance_m({T_box_world * segment.from, T_box_world * segment.to}, obstacle.half_size_m);
  }
  const Segment extent{obstacle.from_world, obstacle.to_world};
  return (obstacle.kind == ObstacleKind::wall ? rectangle_distance_m(segment, extent)
                                              : segment_distance_m(segment, extent)) -
         obstacle.radius_m;
}

Eigen::Vector3d nearest_place(const Eigen::Vector3d& point_world, const Obstacle& obstacle) {
  const Eigen::Vector3d extent = obstacle.to_world - obstacle.from_world,
                        offset = point_world - obstacle.from_world;
  const auto along = [&](const Eigen::Vector3d& way) -> Eigen::Vector3d {
    const double length2 = way.squaredNorm();
    if (length2 <= 0) return Eigen::Vector3d::Zero();
    return std::clamp(offset.dot(way) / length2, 0.0, 1.0) * way;
  };
  if (obstacle.kind != ObstacleKind::wall) return obstacle.from_world + along(extent);
  return obstacle.from_world + along({extent.x(), extent.y(), 0}) + along({0, 0, extent.z()});
}

double clearance_m(const Eigen::Isometry3d& T_world_body, const Airframe& airframe,
                   const std::vector<Obstacle>& obstacles) {
  const std::array<Segment, 2> parts = parts_of(T_world_body, airframe);
  double minimum = std::numeric_limits<double>::infinity();
  lower(minimum, parts, box_around(parts), obstacles);
  return minimum;
}

ClearanceField::ClearanceField(std::vector<Obstacle> obstacles) {
  constexpr std::size_t together = 16;
  int tree = -1;
  for (Obstacle& obstacle : obstacles) {
    const bool new_group =
        groups_.empty() || obstacle.tree != tree || (tree < 0 && groups_.back().obstacles.size() >= together);
    if (new_group) groups_.emplace_back();
    tree = obstacle.tree;
    groups_.back().box_world.extend(box_around(obstacle, 0));
    groups_.back().obstacles.push_back(std::move(obstacle));
  }
}

double ClearanceField::clearance_m(const Eigen::Isometry3d& T_world_body, const Airframe& airframe) const {
  const std::array<Segment, 2> parts = parts_of(T_world_body, airframe);
  const Eigen::AlignedBox3d around = box_around(parts);
  double minimum = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    const double matters_m = std::max(0.0, minimum) + rounding_m;
    if (around.squaredExteriorDistance(group.box_world) > matters_m * matters_m) continue;
    lower(minimum, parts, around, group.obstacles);
  }
  return minimum;
}

double distance_m(const Eigen::Vector3d& point_world, const Obstacle& obstacle) {
  return obstacle_distance_m({point_world, point_world}, obstacle);
}

bool belongs_to(const Eigen::Vector3d& point_world, const Obstacle& obstacle) {
  return belonging_box(obstacle).contains(point_world) &&
         distance_m(point_world, obstacle) < belongs_within_m;
}

Eigen::AlignedBox3d belonging_box(const Obstacle& obstacle) { return box_around(obstacle, belongs_within_m); }

std::optional<std::size_t> nearest_obstacle(const Eigen::Isometry3d& T_world_body, const Airframe& airframe,
                                            const std::vector<Obstacle>& obstacles) {
  std::optional<std::size_t> nearest;
  double minimum_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const double here_m = clearance_m(T_world_body, airframe, {obstacles[i]});
    if (here_m < minimum_m) nearest = i;
    minimum_m = std::min(minimum_m, here_m);
  }
  return nearest;
}

}  // namespace understory
