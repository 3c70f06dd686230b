#include "planning/obstacle_field.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace understory {
namespace {

constexpr double grid_cell_m = 1.0;
constexpr double rounding_m = 1e-9;         // more than any rounding, less than anything that matters
constexpr float single_rounding_m = 1e-3f;  // the same in single precision, over a hundred metres
constexpr double trunk_top_m = 50;          // higher than the flights of any forest

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

/// A point and its horizontal cell. Small, because sorting moves it.
struct CellPoint {
  std::int32_t column, row;
  double z;
  std::size_t index;  ///< of the point

  bool is_beside(const CellPoint& other) const { return column == other.column && row == other.row; }
};

std::int32_t cell_at(double place_m, double cell_m) {
  return static_cast<std::int32_t>(std::floor(place_m / cell_m));
}

/// Cell by cell, columns before rows, and in a cell as `is_before` says. Cells are counted, which is faster
/// than to compare them, unless they lie too far apart.
template <typename IsBefore>
void sort_by_cells(std::vector<CellPoint>& points, IsBefore&& is_before) {
  if (points.empty()) return;
  constexpr std::int64_t most_cells = 1 << 20;
  const auto [left, right] = std::ranges::minmax(points, {}, &CellPoint::column);
  const auto [low, high] = std::ranges::minmax(points, {}, &CellPoint::row);
  const std::int64_t rows = std::int64_t{high.row} - low.row + 1;
  if ((std::int64_t{right.column} - left.column + 1) * rows > most_cells) {
    std::ranges::sort(points, [&](const CellPoint& a, const CellPoint& b) {
      return a.is_beside(b) ? is_before(a, b) : std::tie(a.column, a.row) < std::tie(b.column, b.row);
    });
    return;
  }
  const auto cell = [rows, left = left.column, low = low.row](const CellPoint& point) {
    return static_cast<std::size_t>((point.column - left) * rows + point.row - low);
  };
  std::vector<std::uint32_t> ends(static_cast<std::size_t>((right.column - left.column + 1) * rows));
  for (const CellPoint& point : points) ++ends[cell(point)];
  for (std::size_t i = 1; i < ends.size(); ++i) ends[i] += ends[i - 1];
  std::vector<CellPoint> sorted(points.size());
  for (const CellPoint& point : points) sorted[--ends[cell(point)]] = point;
  points = std::move(sorted);
  for (auto first = points.begin(); first != points.end();) {
    const auto end =
        std::find_if(first, points.end(), [&](const CellPoint& one) { return !one.is_beside(*first); });
    std::sort(first, end, is_before);
    first = end;
  }
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
    cells.push_back({cell_at(at.x(), config.cell_m), cell_at(at.y(), config.cell_m), at.z(), cells.size()});
  }
  // Sorted, because the order of points would change a sum of doubles, and the sum changes plans.
  sort_by_cells(cells, [&](const CellPoint& a, const CellPoint& b) {
    if (a.z != b.z) return a.z < b.z;
    const Eigen::Vector3d &at = points[a.index].position_world, &bt = points[b.index].position_world;
    return std::tie(radii_m[a.index], at.x(), at.y()) < std::tie(radii_m[b.index], bt.x(), bt.y());
  });
  for (std::size_t first = 0; first < cells.size();) {
    std::size_t end = first;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double radius_m = 0;
    while (end < cells.size() && cells[end].is_beside(cells[first]) &&
           (end == first || cells[end].z - cells[end - 1].z <= config.column_gap_m)) {
      sum += points[cells[end].index].position_world.head<2>();
      radius_m = std::max(radius_m, radii_m[cells[end].index]);
      ++end;
    }
    double bottom_m = cells[first].z - config.vertical_reach_m,
           top_m = cells[end - 1].z + config.vertical_reach_m;
    const bool is_trunk = config.trunk_m > 0 && cells[end - 1].z - cells[first].z >= config.trunk_m;
    if (is_trunk) {
      bottom_m = std::min(bottom_m, 0.0);
      top_m = std::max(top_m, trunk_top_m);
    }
    columns_.push_back(
        {sum / static_cast<double>(end - first), bottom_m, top_m, radius_m + 0.5 * config.cell_m});
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
  arrays_.resize(near_.size());
  std::vector<std::int32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t index = 0; index < columns_.size(); ++index)
    for_each_cell_near(columns_[index], [&](int cell) {
      const auto at = static_cast<std::size_t>(next[cell]++);
      const Eigen::Vector2d place = columns_[index].centre_world - grid_origin_;
      near_[at] = static_cast<std::int32_t>(index);
      arrays_.x_m[at] = static_cast<float>(place.x());
      arrays_.y_m[at] = static_cast<float>(place.y());
      arrays_.bottom_m[at] = static_cast<float>(columns_[index].bottom_m);
      arrays_.top_m[at] = static_cast<float>(columns_[index].top_m);
      arrays_.around_m[at] = static_cast<float>(columns_[index].radius_m + config_.wing_radius_m);
    });
}

double ObstacleField::clearance_m(const FlightState& state, double maximum_m) const {
  if (columns_.empty()) return maximum_m;
  const Eigen::Vector2d place = (state.position_world.head<2>() - grid_origin_) / grid_cell_m;
  const int x = static_cast<int>(std::floor(place.x())), y = static_cast<int>(std::floor(place.y()));
  if (x < 0 || y < 0 || x >= grid_width_ || y >= grid_height_) return maximum_m;
  const int cell = y * grid_width_ + x;
  if (cell_start_[cell] == cell_start_[cell + 1]) return maximum_m;

  const Eigen::Vector3d half_wing = config_.half_span_m * left_wing_direction_world(state);
  const Eigen::Vector3d left_tip = state.position_world + half_wing,
                        right_tip = state.position_world - half_wing;
  const auto first = static_cast<std::size_t>(cell_start_[cell]),
             end = static_cast<std::size_t>(cell_start_[cell + 1]);
  const Eigen::Vector3d middle =
      state.position_world - Eigen::Vector3d(grid_origin_.x(), grid_origin_.y(), 0);
  const float least_m =
      bound_clearances(arrays_, first, end - first, middle.cast<float>(), half_wing.cast<float>(), bounds_m_);
  const auto distance_to = [&](std::size_t at) {
    const Column& column = columns_[static_cast<std::size_t>(near_[at])];
    const Eigen::Vector3d bottom(column.centre_world.x(), column.centre_world.y(), column.bottom_m);
    const Eigen::Vector3d top(column.centre_world.x(), column.centre_world.y(), column.top_m);
    return segment_distance_m(left_tip, right_tip, bottom, top) - (column.radius_m + config_.wing_radius_m);
  };
  const auto next = [&](std::size_t from, float most_m) {
    return first + next_within(bounds_m_, from - first, end - first, most_m);
  };
  double minimum = maximum_m;
  // The column that may be nearest goes first: most of the others cannot be nearer.
  if (const std::size_t nearest = next(first, least_m); nearest < end)
    minimum = std::min(minimum, distance_to(nearest));
  const auto matters_m = [&] { return static_cast<float>(minimum) + single_rounding_m; };
  for (std::size_t at = next(first, matters_m()); at < end; at = next(at + 1, matters_m()))
    minimum = std::min(minimum, distance_to(at));
  return minimum;
}

}  // namespace understory
