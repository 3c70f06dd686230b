#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "perception/map/point_grid.hpp"
#include "perception/obstacle_point.hpp"
#include "perception/perception_config.hpp"
#include "perception/stereo_hit.hpp"

namespace understory {

/// Remembers hits in the estimator's world frame (its continuous odometry frame) until the aircraft has
/// passed them (Barry & Tedrake 2015: past detections carried by odometry). Points never move except when
/// seen again. Deterministic: the same calls give the same points in the same order.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapConfig& config);

  /// Adds one frame's hits. The pose is that of the left camera at the moment t_ns of the image, not of now;
  /// distance_flown_m is the odometer then. A hit in an occupied voxel replaces that point's position, time,
  /// score and odometer (the newest sighting has drifted least) and raises its `sightings` once a frame.
  void insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera, std::int64_t t_ns,
              double distance_flown_m);

  /// Forgets points older than max_age_s at t_ns, and points more than passed_m behind the aircraft. Behind
  /// is measured along body x laid level: a bank does not change it, and neither does the nose's height, so a
  /// point abreast of a wing stays whatever the attitude. With the nose straight up or down only age counts.
  void forget_passed(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns);

  /// Every remembered point, in order of first sighting.
  const std::vector<ObstaclePoint>& points() const { return points_; }
  /// Those with company: min_neighbours other points within neighbour_radius_m, from whatever frames, and
  /// where seen_again is on, support from a second frame. Computed at each call, about 0.6 ms at
  /// 5,000 points.
  std::vector<ObstaclePoint> trusted_points() const;
  /// Hits ever inserted, merged ones included.
  std::int64_t inserted_count() const { return inserted_count_; }

 private:
  bool merge(const ObstaclePoint& point);
  void keep_newest();
  void rebuild_voxels();
  bool trusted(std::size_t index, const PointGrid& grid) const;

  LocalMapConfig config_;
  std::vector<ObstaclePoint> points_;
  PointGrid voxels_;
  std::int64_t inserted_count_ = 0;
};

}  // namespace understory
