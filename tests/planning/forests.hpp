#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "planning/flight_model.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/plan.hpp"

/// Forests as the map would remember them, and a plain computation of a wing's distance to them.
namespace understory {

/// A trunk as a stack of remembered points, exactly upright, so that the field's column stands exactly there.
struct Trunk {
  Eigen::Vector2d foot_world;
  double bottom_m = 0;
  double top_m = 9;
};

inline std::vector<ObstaclePoint> points_of(const std::vector<Trunk>& trunks) {
  std::vector<ObstaclePoint> points;
  for (const Trunk& trunk : trunks)
    for (double z = trunk.bottom_m; z <= trunk.top_m + 1e-9; z += 0.5) {
      ObstaclePoint point;
      point.position_world = {trunk.foot_world.x(), trunk.foot_world.y(), z};
      points.push_back(point);
    }
  return points;
}

/// Trunks spread evenly at random over [x_from, x_to] x [-10, 10] m.
inline std::vector<Trunk> random_forest(std::mt19937_64& generator, int count, double x_from_m,
                                        double x_to_m) {
  std::uniform_real_distribution<double> x(x_from_m, x_to_m), y(-10, 10);
  std::vector<Trunk> trunks;
  for (int i = 0; i < count; ++i) {
    const double ahead_m = x(generator);
    trunks.push_back({{ahead_m, y(generator)}});
  }
  return trunks;
}

/// Trunks without a gap across everything an aircraft could reach, too deep for one step of a rollout to
/// jump.
inline std::vector<Trunk> wall(double x_m) {
  std::vector<Trunk> trunks;
  for (double depth_m = 0; depth_m < 0.7; depth_m += 0.2)
    for (double y = -40; y <= 40; y += 0.15) trunks.push_back({{x_m + depth_m, y}, -4, 16});
  return trunks;
}

/// The left wing's direction from heading, climb and bank, as a product of elementary rotations: not the
/// library's.
inline Eigen::Vector3d left_wing_by_rotations(double heading_rad, double climb_angle_rad, double bank_rad) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(heading_rad, Vector3d::UnitZ()) * AngleAxisd(-climb_angle_rad, Vector3d::UnitY()) *
         AngleAxisd(bank_rad, Vector3d::UnitX()) * Vector3d::UnitY();
}

/// Distance from a wing's centre line to an upright line, by walking along the wing in steps of less than
/// half a millimetre: an upper bound of the true distance by at most a quarter of one.
inline double wing_distance_by_walking_m(const Eigen::Vector3d& centre_world,
                                         const Eigen::Vector3d& left_wing_world, double half_span_m,
                                         const Eigen::Vector2d& foot_world, double bottom_m, double top_m) {
  double minimum = std::numeric_limits<double>::infinity();
  for (int step = -1000; step <= 1000; ++step) {
    const Eigen::Vector3d at = centre_world + step / 1000.0 * half_span_m * left_wing_world;
    const double above = std::max({0.0, bottom_m - at.z(), at.z() - top_m});
    minimum = std::min(minimum, std::hypot((at.head<2>() - foot_world).norm(), above));
  }
  return minimum;
}

/// Minimum distance over a plan between the wing and the trunks' axes. The plan's first point is where the
/// aircraft is anyway, so it is left out.
inline double plan_distance_m(const Plan& plan, const std::vector<Trunk>& trunks,
                              const ObstacleFieldConfig& config) {
  double minimum = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < plan.points.size(); ++i) {
    const PlanPoint& point = plan.points[i];
    const Eigen::Vector3d left =
        left_wing_by_rotations(point.heading_rad, point.climb_angle_rad, point.bank_rad);
    for (const Trunk& trunk : trunks) {
      if ((trunk.foot_world - point.position_world.head<2>()).norm() > 1.5) continue;
      minimum = std::min(minimum, wing_distance_by_walking_m(point.position_world, left, config.half_span_m,
                                                             trunk.foot_world, trunk.bottom_m, trunk.top_m));
    }
  }
  return minimum;
}

}  // namespace understory
