#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/map/local_map.hpp"

namespace understory {

/// The map of a flight, carried by recorded poses of the camera instead of an estimate.
class PosedMap {
 public:
  explicit PosedMap(const LocalMapConfig& config) : map_(config) {}

  /// Takes in one frame's hits, taken at t_ns. The camera's viewing direction decides which points count as
  /// passed, since a recorded body's axes may point anywhere (EuRoC's x points up).
  void insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera,
              std::int64_t t_ns) {
    if (moved_) distance_flown_m_ += (T_world_camera.translation() - camera_world_).norm();
    moved_ = true;
    camera_world_ = T_world_camera.translation();
    map_.insert(hits, T_world_camera, t_ns, distance_flown_m_);
    // The axes of a body whose x is the camera's axis.
    const Eigen::Isometry3d T_camera_looking = T_body_camera_of(Eigen::Vector3d::Zero(), 0).inverse();
    map_.forget_passed(T_world_camera * T_camera_looking, t_ns);
  }

  const std::vector<ObstaclePoint>& points() const { return map_.points(); }

 private:
  LocalMap map_;
  Eigen::Vector3d camera_world_ = Eigen::Vector3d::Zero();  ///< at the newest frame taken in
  bool moved_ = false;
  double distance_flown_m_ = 0;
};

}  // namespace understory
