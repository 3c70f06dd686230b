#include "sim/cameras/camera_frustum.hpp"

namespace understory {

std::array<Eye, 2> eyes_of(const StereoRig& rig, const Eigen::Isometry3d& T_world_body) {
  Eye left{T_world_body * rig.T_body_camera,
           rig.focal_px,
           rig.center_left_x_px,
           rig.center_y_px,
           rig.width_px,
           rig.height_px};
  Eye right = left;
  right.T_world_camera = left.T_world_camera * Eigen::Translation3d(rig.baseline_m, 0, 0);
  right.center_x_px = rig.center_right_x_px;
  return {left, right};
}

bool may_see(const Eye& eye, const GeomBox& box) {
  // Inward normals, camera frame, of left, right, top, bottom and of the plane at the eye itself.
  const double f = eye.focal_px;
  const std::array<Eigen::Vector3d, 5> planes = {
      Eigen::Vector3d(f, 0, eye.center_x_px + 0.5),
      Eigen::Vector3d(-f, 0, eye.width_px - 0.5 - eye.center_x_px),
      Eigen::Vector3d(0, f, eye.center_y_px + 0.5),
      Eigen::Vector3d(0, -f, eye.height_px - 0.5 - eye.center_y_px), Eigen::Vector3d(0, 0, 1)};
  const Eigen::Isometry3d T_camera_box = eye.T_world_camera.inverse(Eigen::Isometry) * box.T_world_box;
  for (const Eigen::Vector3d& plane : planes) {
    const Eigen::Vector3d along_box = T_camera_box.linear().transpose() * plane;
    if (plane.dot(T_camera_box.translation()) + along_box.cwiseAbs().dot(box.half_size) < 0) return false;
  }
  return true;
}

double distance_m(const Eigen::Vector3d& point_world, const GeomBox& box) {
  const Eigen::Vector3d inside = box.T_world_box.inverse(Eigen::Isometry) * point_world;
  return (inside.cwiseAbs() - box.half_size).cwiseMax(0).norm();
}

}  // namespace understory
