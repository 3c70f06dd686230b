#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "perception/map/local_map.hpp"

namespace understory {

/// The map of a flight, carried by recorded poses of the camera instead of an estimate.
class PosedMap {
 public:
  explicit PosedMap(const LocalMapConfig& config) : map_(config) {}

  /// Takes in one frame's hits, taken at t_ns. What counts as passed is told by where the camera looks, since
  /// a recorded body's axes may point anywhere (EuRoC's x points up).
  void insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera, std::int64_t t_ns);

  const std::vector<ObstaclePoint>& points() const { return map_.points(); }

 private:
  LocalMap map_;
  Eigen::Vector3d camera_world_ = Eigen::Vector3d::Zero();  ///< at the newest frame taken in
  bool moved_ = false;
  double distance_flown_m_ = 0;
};

}  // namespace understory
