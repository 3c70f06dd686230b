#include "planning/obstacle_field.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace understory {
namespace {

constexpr double grid_cell_m = 1.0;
constexpr double rounding_m = 1e-9;  // more than any rounding, less than anything that matters

// Minimum distance between the segments a0-a1 and b0-b1: Ericson 2005, Real-Time Collision Detection, section
// 5.1.9.
double segment_distance_m(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                          const Eigen::Vector3d& b1) {
  const Eigen::Vector3d along_a = a1 - a0, along_b = b1 - b0, between = a0 - b0;
  const double aa = std::max(along_a.squaredNorm(), 1e-12), bb = std::max(along_b.squaredNorm(), 1e-12);
  const double ab = along_a.dot(along_b), ac = along_a.dot(between), bc = along_b.dot(between);
  const double determinant = aa * bb - ab * ab;
  double s = determinant > 1e-9 ? std::clamp((ab * bc - ac * bb) / determinant, 0.0, 1.0) : 0.5;
  double t = std::clamp((ab * s + bc) / bb, 0.0, 1.0);
  s = std::clamp((ab * t - ac) / aa, 0.0, 1.0);
  t = std::clamp((ab * s + bc) / bb, 0.0, 1.0);
  return (between + s * along_a - t * along_b).norm();
}

/// A point and its horizontal cell. Small, because sorting moves it, and sorting is half of a field's cost.
struct CellPoint {
  std::uint64_t cell;  ///< in the order of the cells' columns, then rows
  double z;
  std::size_t index;  ///< of the point
};

std::uint64_t cell_number(double column, double row) {
  const auto ordered = [](double whole) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(whole)) ^
           0x80000000u;  // sorts negative numbers first
  };
  return std::uint64_t{ordered(column)} << 32 | ordered(row);
}

}  // namespace

ObstacleField::ObstacleField(const ObstacleFieldConfig& config, const std::vector<ObstaclePoint>& points,
                             double distance_flown_m, double maximum_asked_m)
    : config_(config) {
  std::vector<CellPoint> cells;
  std::vector<double> radii_m;  // of the points' uncertainty
  cells.reserve(points.size());
  radii_m.reserve(points.size());
  for (const ObstaclePoint& point : points) {
    const double flown_m = std::max(0.0, distance_flown_m - point.distance_flown_m);
    radii_m.push_back(std::min(config.sigma_zero_m + config.sigma_per_m * flown_m, config.sigma_maximum_m));
    const Eigen::Vector3d& at = point.position_world;
    cells.push_back({cell_number(std::floor(at.x() / config.cell_m), std::floor(at.y() / config.cell_m)),
                     at.z(), cells.size()});
  }
  // Sorted, because the order of points would change a sum of doubles, and the sum changes plans.
  std::sort(cells.begin(), cells.end(), [&](const CellPoint& a, const CellPoint& b) {
    if (a.cell != b.cell) return a.cell < b.cell;
    if (a.z != b.z) return a.z < b.z;
    const Eigen::Vector3d &at = points[a.index].position_world, &bt = points[b.index].position_world;
    return std::tie(radii_m[a.index], at.x(), at.y()) < std::tie(radii_m[b.index], bt.x(), bt.y());
  });
  for (std::size_t first = 0; first < cells.size();) {
    std::size_t end = first;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double radius_m = 0;
    while (end < cells.size() && cells[end].cell == cells[first].cell &&
           (end == first || cells[end].z - cells[end - 1].z <= config.column_gap_m)) {
      sum += points[cells[end].index].position_world.head<2>();
      radius_m = std::max(radius_m, radii_m[cells[end].index]);
      ++end;
    }
    double bottom_m = cells[first].z - config.vertical_reach_m;
    if (config.stands_on_ground) bottom_m = std::min(bottom_m, 0.0);
    columns_.push_back({sum / static_cast<double>(end - first), bottom_m,
                        cells[end - 1].z + config.vertical_reach_m, radius_m + 0.5 * config.cell_m});
    first = end;
  }
  double maximum_radius_m = 0;
  for (const Column& column : columns_) maximum_radius_m = std::max(maximum_radius_m, column.radius_m);
  build_grid(config.half_span_m + config.wing_radius_m + maximum_radius_m + maximum_asked_m + rounding_m);
}

void ObstacleField::build_grid(double reach_m) {
  if (columns_.empty()) return;
  Eigen::Vector2d low = columns_.front().centre_world, high = low;
  for (const Column& column : columns_) {
    low = low.cwiseMin(column.centre_world);
    high = high.cwiseMax(column.centre_world);
  }
  grid_origin_ = low.array() - reach_m;
  const Eigen::Vector2d size = high.array() + reach_m - grid_origin_.array();
  grid_width_ = static_cast<int>(size.x() / grid_cell_m) + 1;
  grid_height_ = static_cast<int>(size.y() / grid_cell_m) + 1;

  const auto for_each_cell_near = [&](const Column& column, auto&& visit) {
    const Eigen::Vector2d at = (column.centre_world - grid_origin_) / grid_cell_m;
    const double reach = reach_m / grid_cell_m;
    for (int y = std::max(0, static_cast<int>(at.y() - reach)); y <= at.y() + reach && y < grid_height_; ++y)
      for (int x = std::max(0, static_cast<int>(at.x() - reach)); x <= at.x() + reach && x < grid_width_; ++x)
        visit(y * grid_width_ + x);
  };
  // Counting sort of (cell, column) pairs: count, sum up, fill.
  cell_start_.assign(static_cast<std::size_t>(grid_width_) * grid_height_ + 1, 0);
  for (const Column& column : columns_)
    for_each_cell_near(column, [&](int cell) { ++cell_start_[cell + 1]; });
  for (std::size_t cell = 1; cell < cell_start_.size(); ++cell) cell_start_[cell] += cell_start_[cell - 1];
  near_.resize(static_cast<std::size_t>(cell_start_.back()));
  std::vector<std::int32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t index = 0; index < columns_.size(); ++index)
    for_each_cell_near(columns_[index], [&](int cell) {
      near_[static_cast<std::size_t>(next[cell]++)] = {columns_[index].centre_world,
                                                       columns_[index].radius_m + config_.wing_radius_m,
                                                       static_cast<std::int32_t>(index)};
    });
}

double ObstacleField::clearance_m(const FlightState& state, double maximum_m) const {
  if (columns_.empty()) return maximum_m;
  const Eigen::Vector2d at = (state.position_world.head<2>() - grid_origin_) / grid_cell_m;
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  if (x < 0 || y < 0 || x >= grid_width_ || y >= grid_height_) return maximum_m;
  const int cell = y * grid_width_ + x;
  if (cell_start_[cell] == cell_start_[cell + 1]) return maximum_m;

  const Eigen::Vector3d half_wing = config_.half_span_m * left_wing_direction_world(state);
  const Eigen::Vector3d left_tip = state.position_world + half_wing,
                        right_tip = state.position_world - half_wing;
  const Eigen::Vector2d across = half_wing.head<2>();
  const double per_across_m2 = 1 / std::max(across.squaredNorm(), 1e-12);
  double minimum = maximum_m;
  for (int k = cell_start_[cell]; k < cell_start_[cell + 1]; ++k) {
    const Near& near = near_[static_cast<std::size_t>(k)];
    // Seen from above, a column is nowhere nearer than its axis: a point beside the wing's projection.
    const double matters_m = minimum + near.around_m + rounding_m;
    if (matters_m <= 0) continue;
    const Eigen::Vector2d beside = near.centre_world - state.position_world.head<2>();
    const double along = std::clamp(beside.dot(across) * per_across_m2, -1.0, 1.0);
    if ((beside - along * across).squaredNorm() > matters_m * matters_m) continue;
    const Column& column = columns_[static_cast<std::size_t>(near.column)];
    const Eigen::Vector3d bottom(column.centre_world.x(), column.centre_world.y(), column.bottom_m);
    const Eigen::Vector3d top(column.centre_world.x(), column.centre_world.y(), column.top_m);
    minimum = std::min(minimum, segment_distance_m(left_tip, right_tip, bottom, top) - near.around_m);
  }
  return minimum;
}

}  // namespace understory
