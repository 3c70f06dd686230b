#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "perception/perception_config.hpp"
#include "perception/stereo_hit.hpp"

namespace understory {

/// Points hashed by the cubic cell they lie in, numbered 0, 1, 2 ... as they are added. Cheap to fill and to
/// throw away, which for a map that changes at every frame beats a search tree. Chains are walked in a fixed
/// order.
class PointGrid {
 public:
  explicit PointGrid(double cell_m) : cell_m_(cell_m) { clear(); }

  void clear();
  void add(const Eigen::Vector3d& position);
  /// The last point added to the cell that `position` lies in, or -1.
  int find_in_cell(const Eigen::Vector3d& position) const;

  /// Calls visit(index) for every point in the cell of `position` and the 26 around it, among which are all
  /// points within one cell size; stops as soon as visit returns false.
  template <typename Visit>
  void visit_near(const Eigen::Vector3d& position, Visit&& visit) const {
    const Cell center = cell_of(position);
    if (!visit_cell(center, visit)) return;  // first, since the nearest points are likeliest here
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          if ((dx || dy || dz) && !visit_cell({center[0] + dx, center[1] + dy, center[2] + dz}, visit))
            return;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Eigen::Vector3d& position) const {
    return {static_cast<std::int64_t>(std::floor(position.x() / cell_m_)),
            static_cast<std::int64_t>(std::floor(position.y() / cell_m_)),
            static_cast<std::int64_t>(std::floor(position.z() / cell_m_))};
  }
  std::size_t bucket_of(const Cell& cell) const;
  /// std::array's == calls memcmp, which here costs more than everything around it.
  static bool same(const Cell& a, const Cell& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

  template <typename Visit>
  bool visit_cell(const Cell& cell, Visit& visit) const {
    for (int index = heads_[bucket_of(cell)]; index >= 0; index = next_[static_cast<std::size_t>(index)])
      if (same(cells_[static_cast<std::size_t>(index)], cell) && !visit(index)) return false;
    return true;
  }
  void link(std::size_t index);

  double cell_m_;
  std::vector<int> heads_;  // newest point of each bucket, -1 where empty; a power of two of them
  std::vector<int> next_;   // the point added to the same bucket before
  std::vector<Cell> cells_;
};

/// Remembers hits in the estimator's world frame (its continuous odometry frame) until the aircraft has
/// passed them (Barry & Tedrake 2015: past detections carried by odometry). Points never move except when
/// seen again, and by move(). Deterministic: the same calls give the same points in the same order.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapConfig& config);

  /// Adds one frame's hits. The pose is that of the left camera at the moment t_ns of the image, not of now;
  /// distance_flown_m is the odometer then. A hit in an occupied voxel replaces that point's position, time,
  /// score and odometer (the newest sighting has drifted least) and raises its `sightings` once a frame.
  void insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera, std::int64_t t_ns,
              double distance_flown_m);

  /// Forgets points older than max_age_s at t_ns, and points more than passed_m behind the aircraft. This
  /// distance is measured along the horizontal projection of body x. So neither bank nor pitch changes it,
  /// and a point abreast of a wing stays at any attitude. With the nose straight up or down only age counts.
  void forget_passed(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns);

  /// From now on these settings; voxel_m stays.
  void change(const LocalMapConfig& config);
  /// Where a remembered point is now; nothing: it is forgotten.
  using Place = std::function<std::optional<Eigen::Vector3d>(const ObstaclePoint&)>;
  void move(const Place& place);

  /// Every remembered point, in order of first sighting.
  const std::vector<ObstaclePoint>& points() const { return points_; }
  /// The points with min_neighbours other points within neighbour_radius_m, from any frames, and, if
  /// seen_again is on, support from a second frame. Computed at each call, about 0.6 ms at 5,000 points.
  std::vector<ObstaclePoint> trusted_points() const;

 private:
  bool merge(const ObstaclePoint& point);
  void keep_newest();
  void rebuild_voxels();
  bool trusted(std::size_t index, const PointGrid& grid) const;

  LocalMapConfig config_;
  std::vector<ObstaclePoint> points_;
  PointGrid voxels_;
};

}  // namespace understory
