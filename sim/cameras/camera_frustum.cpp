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

mjvGLCamera to_gl(const Eye& eye) {
  mjvGLCamera camera{};
  const Eigen::Matrix3d rotation = eye.T_world_camera.linear();
  for (int i = 0; i < 3; ++i) {
    camera.pos[i] = static_cast<float>(eye.T_world_camera.translation()[i]);
    camera.forward[i] = static_cast<float>(rotation(i, 2));
    camera.up[i] = static_cast<float>(-rotation(i, 1));  // OpenCV's y looks down
  }
  // Edges on the near plane. MuJoCo takes the centre and derives the half width from the viewport's aspect.
  const double metres_per_pixel = near_m / eye.focal_px;
  camera.frustum_center = static_cast<float>((0.5 * (eye.width_px - 1) - eye.center_x_px) * metres_per_pixel);
  camera.frustum_top = static_cast<float>((eye.center_y_px + 0.5) * metres_per_pixel);
  camera.frustum_bottom = static_cast<float>((eye.center_y_px + 0.5 - eye.height_px) * metres_per_pixel);
  camera.frustum_near = static_cast<float>(near_m);
  camera.frustum_far = static_cast<float>(far_m);
  return camera;
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
