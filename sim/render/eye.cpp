#include "sim/render/eye.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <opencv2/core.hpp>

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
namespace {

constexpr float horizon_gray = 215;  // an overcast sky, short of saturation
constexpr float zenith_gray = 190;

/// Elevation of a pixel's ray: 0 at the horizon and below, 1 from 45 degrees up, linear in the pixel
/// coordinates.
struct SkyRow {
  float at_left, per_pixel;
  float steepness(int column) const {
    return std::min(std::max(at_left + per_pixel * static_cast<float>(column), 0.0f), 1.0f);
  }
};

SkyRow sky_row(const Eye& eye, int row) {
  const Eigen::Vector3d up = eye.T_world_camera.linear().row(2) / eye.focal_px;  // world z in camera axes
  const double left = -eye.center_x_px * up.x() + (row - eye.center_y_px) * up.y() + eye.focal_px * up.z();
  return {static_cast<float>(left), static_cast<float>(up.x())};
}

}  // namespace

cv::Mat gray_with_sky(const std::uint8_t* rgba, int stride_px, const Eye& eye) {
  static_assert(std::endian::native == std::endian::little);
  cv::Mat gray(eye.height_px, eye.width_px, CV_8UC1);
  const int columns = eye.width_px;
  for (int row = 0; row < eye.height_px; ++row) {
    const std::uint8_t* source = rgba + std::size_t{4} * stride_px * (eye.height_px - 1 - row);
    std::uint8_t* target = gray.ptr<std::uint8_t>(row);
    const SkyRow sky = sky_row(eye, row);
    for (int column = 0; column < columns; ++column) {
      const float bright = horizon_gray + (zenith_gray - horizon_gray) * sky.steepness(column);
      std::uint32_t pixel;
      std::memcpy(&pixel, source + 4 * column, sizeof pixel);
      const int green = static_cast<int>(pixel >> 8 & 0xFF), sky_gray = static_cast<int>(bright);
      target[column] = static_cast<std::uint8_t>(pixel >> 24 != 0 ? green : sky_gray);
    }
  }
  return gray;
}

cv::Mat colour_with_sky(const std::uint8_t* rgba, const Eye& eye) {
  cv::Mat colour(eye.height_px, eye.width_px, CV_8UC3);
  for (int row = 0; row < eye.height_px; ++row) {
    const std::uint8_t* source = rgba + std::size_t{4} * eye.width_px * (eye.height_px - 1 - row);
    auto* target = colour.ptr<cv::Vec3b>(row);
    const SkyRow sky = sky_row(eye, row);
    for (int column = 0; column < eye.width_px; ++column, source += 4) {
      const float blue = sky.steepness(column);
      const cv::Vec3b air(cv::saturate_cast<std::uint8_t>(235 - 10 * blue),
                          cv::saturate_cast<std::uint8_t>(218 - 30 * blue),
                          cv::saturate_cast<std::uint8_t>(205 - 60 * blue));
      target[column] = source[3] != 0 ? cv::Vec3b(source[2], source[1], source[0]) : air;
    }
  }
  return colour;
}

}  // namespace understory
