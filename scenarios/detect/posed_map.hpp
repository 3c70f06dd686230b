#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "perception/map/local_map.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// The map of a flight, carried by recorded poses instead of an estimate.
class PosedMap {
 public:
  PosedMap(std::vector<TimedPose> poses, const StereoRig& rig, const LocalMapConfig& config);

  /// Takes in one frame's hits, taken at t_ns. False where the poses do not cover that moment: nothing
  /// happens then. What counts as passed is told by where the left camera looks, since a recorded body's axes
  /// may point anywhere (EuRoC's x points up).
  bool insert(const std::vector<StereoHit>& hits, std::int64_t t_ns);

  /// What the map holds now, and the camera's pose at the newest frame taken in.
  const std::vector<ObstaclePoint>& points() const { return map_.points(); }
  const Eigen::Isometry3d& T_world_camera() const { return T_world_camera_; }
  /// Every point that ever came in, as when it was first seen.
  const std::vector<ObstaclePoint>& remembered() const { return remembered_; }

 private:
  std::vector<TimedPose> poses_;
  Eigen::Isometry3d T_body_camera_, T_world_camera_ = Eigen::Isometry3d::Identity();
  LocalMap map_;
  std::vector<ObstaclePoint> remembered_;
  double distance_flown_m_ = 0;
  bool moved_ = false;
};

}  // namespace understory
