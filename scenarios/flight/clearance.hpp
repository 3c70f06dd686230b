#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "planning/airframe.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// Two points and the straight line between them, m.
struct Segment {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
};

/// Minimum distance between two segments, m (Ericson, Real-Time Collision Detection 2005, section 5.1.9).
double segment_distance_m(const Segment& a, const Segment& b);

/// Minimum distance between a segment and a box about the origin, m; 0 where the segment enters it.
double box_distance_m(const Segment& segment, const Eigen::Vector3d& half_size_m);

/// Minimum distance between a segment and an obstacle's surface, m; not positive where they touch.
double obstacle_distance_m(const Segment& segment, const Obstacle& obstacle);

/// From a point to an obstacle's surface, m; negative within.
double distance_m(const Eigen::Vector3d& point_world, const Obstacle& obstacle);

/// The place on an obstacle's axis, or on a wall's middle plane, that is nearest to a point.
Eigen::Vector3d nearest_place(const Eigen::Vector3d& point_world, const Obstacle& obstacle);

/// The true minimum distance between the aircraft and the obstacles' surfaces, m; negative where they
/// overlap, +infinity without obstacles. The aircraft is its wing as a segment between the tips and its body
/// as one from nose to tail (the root chord of a delta is about twice the mean chord).
double clearance_m(const Eigen::Isometry3d& T_world_body, const Airframe& airframe,
                   const std::vector<Obstacle>& obstacles);

/// The same for obstacles that do not move: those far away are skipped in groups, by tree or by the dozen.
class ClearanceField {
 public:
  explicit ClearanceField(std::vector<Obstacle> obstacles);
  double clearance_m(const Eigen::Isometry3d& T_world_body, const Airframe& airframe) const;

 private:
  struct Group {
    Eigen::AlignedBox3d box_world;  ///< of the obstacles with their surfaces
    std::vector<Obstacle> obstacles;
  };
  std::vector<Group> groups_;
};

/// A detected or remembered point this near to an obstacle's surface belongs to it, m: the uncertainty of
/// stereo at 10 m and of the estimate's drift.
constexpr double belongs_within_m = 0.5;
bool belongs_to(const Eigen::Vector3d& point_world, const Obstacle& obstacle);
/// Holds every point that belongs to the obstacle, and some that do not.
Eigen::AlignedBox3d belonging_box(const Obstacle& obstacle);

/// The obstacle that this clearance is smallest to; nothing without obstacles.
std::optional<std::size_t> nearest_obstacle(const Eigen::Isometry3d& T_world_body, const Airframe& airframe,
                                            const std::vector<Obstacle>& obstacles);

}  // namespace understory
