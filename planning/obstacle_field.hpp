#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "planning/autopilot_config.hpp"
#include "planning/flight_model.hpp"

namespace understory {

/// The remembered points for the planner: upright columns in a horizontal grid. They give the free distance
/// to a wing in a given attitude. The field is rebuilt for each replan. A search needs about ten thousand
/// distances. Not thread safe, not even to read.
class ObstacleField {
 public:
  struct Column {
    Eigen::Vector2d centre_world;
    double bottom_m, top_m;
    double radius_m;  ///< half a cell and the points' uncertainty
  };

  /// Heights of `points` are above the ground. `maximum_asked_m`: the maximum clearance that will be
  /// requested. A smaller one is cheaper.
  ObstacleField(const ObstacleFieldConfig& config, const std::vector<ObstaclePoint>& points,
                double distance_flown_m, double maximum_asked_m = 3.0);

  /// Free distance from the wing (a capsule from tip to tip, banked as in `state`) to the nearest column, m.
  /// Negative in a collision. At most `maximum_m`, which is the answer in free space and at most the
  /// constructor's `maximum_asked_m`.
  double clearance_m(const FlightState& state, double maximum_m) const;

  const std::vector<Column>& columns() const { return columns_; }

 private:
  void build_grid(double reach_m);
  void bound_distances(const Eigen::Vector3d& middle, const Eigen::Vector3d& half_wing, std::size_t first,
                       std::size_t end) const;

  ObstacleFieldConfig config_;
  std::vector<Column> columns_;
  Eigen::Vector2d grid_origin_ = Eigen::Vector2d::Zero();
  int grid_width_ = 0, grid_height_ = 0;
  std::vector<std::int32_t> cell_start_;  ///< per cell, into near_; one more than there are cells
  /// Columns within reach of each cell, and, side by side for a compiler that vectorizes, where their axes
  /// are (from the grid's origin) and how thick they and the wing are.
  std::vector<std::int32_t> near_;
  std::vector<float> near_x_m_, near_y_m_, near_bottom_m_, near_top_m_, near_around_m_;
  mutable std::vector<float> squared_m2_;  ///< scratch memory of clearance_m()
};

}  // namespace understory
