#include "scenarios/detect/posed_map.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "perception/io/rig_file.hpp"

namespace understory {

PosedMap::PosedMap(std::vector<TimedPose> poses, const StereoRig& rig, const LocalMapConfig& config)
    : poses_(std::move(poses)), T_body_camera_(rig.T_body_camera), map_(config) {}

bool PosedMap::insert(const std::vector<StereoHit>& hits, std::int64_t t_ns) {
  const auto T_world_body = pose_at(poses_, t_ns);
  if (!T_world_body) return false;
  const Eigen::Isometry3d T_world_camera = *T_world_body * T_body_camera_;
  if (moved_) distance_flown_m_ += (T_world_camera.translation() - T_world_camera_.translation()).norm();
  moved_ = true;
  T_world_camera_ = T_world_camera;
  map_.insert(hits, T_world_camera, t_ns, distance_flown_m_);
  // The axes of a body whose x is the camera's axis.
  const Eigen::Isometry3d T_camera_looking = T_body_camera_of(Eigen::Vector3d::Zero(), 0).inverse();
  map_.forget_passed(T_world_camera * T_camera_looking, t_ns);
  std::copy_if(points().begin(), points().end(), std::back_inserter(remembered_),
               [&](const ObstaclePoint& point) { return point.t_ns == t_ns && point.sightings == 1; });
  return true;
}

}  // namespace understory
