#include "scenarios/detect/posed_map.hpp"

#include "perception/io/rig_file.hpp"

namespace understory {

void PosedMap::insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera,
                      std::int64_t t_ns) {
  if (moved_) distance_flown_m_ += (T_world_camera.translation() - camera_world_).norm();
  moved_ = true;
  camera_world_ = T_world_camera.translation();
  map_.insert(hits, T_world_camera, t_ns, distance_flown_m_);
  // The axes of a body whose x is the camera's axis.
  const Eigen::Isometry3d T_camera_looking = T_body_camera_of(Eigen::Vector3d::Zero(), 0).inverse();
  map_.forget_passed(T_world_camera * T_camera_looking, t_ns);
}

}  // namespace understory
