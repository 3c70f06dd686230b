#include "scenarios/flight/obstacle_view.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenarios/flight/clearance.hpp"
#include "scenarios/parts/oracles.hpp"
#include "sim/sensors/faults.hpp"

namespace understory {
namespace {

/// Columns and rows of the left image within which the obstacle lies, at most; empty where it lies elsewhere.
struct ImageWindow {
  int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
};

ImageWindow window_of(const StereoRig& rig, const Eigen::Isometry3d& T_camera_world,
                      const Obstacle& obstacle) {
  constexpr double nearest_m = 0.05;
  const Eigen::Vector3d& from = obstacle.from_world;
  const Eigen::Vector3d& to = obstacle.to_world;
  std::vector<Eigen::Vector3d> corners{from, to};
  if (obstacle.kind == ObstacleKind::wall) {
    corners.emplace_back(from.x(), from.y(), to.z());
    corners.emplace_back(to.x(), to.y(), from.z());
  }
  Eigen::AlignedBox2d seen;
  bool is_ahead = false, is_behind = false;
  for (const Eigen::Vector3d& corner_world : corners) {
    const Eigen::Vector3d corner = T_camera_world * corner_world;
    (corner.z() > nearest_m ? is_ahead : is_behind) = true;
    if (corner.z() <= nearest_m) continue;
    const Eigen::Vector2d at(rig.focal_px * corner.x() / corner.z() + rig.center_left_x_px,
                             rig.focal_px * corner.y() / corner.z() + rig.center_y_px);
    const Eigen::Vector2d wide = Eigen::Vector2d::Constant(rig.focal_px * obstacle.radius_m / corner.z() + 1);
    seen.extend(at - wide).extend(at + wide);
  }
  if (!is_ahead) return {};
  if (is_behind) return {0, rig.width_px - 1, 0, rig.height_px - 1};
  const auto within = [](double at, int size) { return static_cast<int>(std::clamp(at, -1.0, 1.0 * size)); };
  return {std::max(0, within(seen.min().x(), rig.width_px)),
          std::min(rig.width_px - 1, within(seen.max().x(), rig.width_px)),
          std::max(0, within(seen.min().y(), rig.height_px)),
          std::min(rig.height_px - 1, within(seen.max().y(), rig.height_px))};
}

}  // namespace

int pixels_in_view(const FlightLog& log, std::int64_t t_ns, const Eigen::Isometry3d& T_world_body,
                   std::size_t obstacle, int enough) {
  const StereoRig& rig = log.rig.rig;
  const Eigen::Isometry3d T_world_camera = T_world_body * rig.T_body_camera;
  const Eigen::Vector3d eye_world = T_world_camera.translation();
  const Obstacle& target = log.obstacles[obstacle];
  if (distance_m(eye_world, target) > log.scenario.cameras.view_distance_m) return 0;
  ImageWindow window = window_of(rig, T_world_camera.inverse(), target);
  if (const auto cover = Faults(log.scenario.faults).value(FaultySensor::camera, FaultKind::cover, t_ns)) {
    const auto [first, end] = free_columns(*cover, rig.width_px);
    window.first_column = std::max(window.first_column, first);
    window.last_column = std::min(window.last_column, end - 1);
  }
  int pixels = 0;
  for (int row = window.first_row; row <= window.last_row; ++row)
    for (int column = window.first_column; column <= window.last_column; ++column) {
      const Eigen::Vector3d ray_world =
          T_world_camera.linear() * Eigen::Vector3d((column - rig.center_left_x_px) / rig.focal_px,
                                                    (row - rig.center_y_px) / rig.focal_px, 1);
      const double reach = ray_meets(eye_world, ray_world, target);
      if (!std::isfinite(reach)) continue;
      const bool is_hidden = std::ranges::any_of(log.obstacles, [&](const Obstacle& other) {
        return &other != &target && ray_meets(eye_world, ray_world, other) < reach;
      });
      if (!is_hidden && ++pixels >= enough) return pixels;
    }
  return pixels;
}

}  // namespace understory
