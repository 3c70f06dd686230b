#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "planning/autopilot_config.hpp"
#include "planning/column_bounds.hpp"
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

  ObstacleFieldConfig config_;
  std::vector<Column> columns_;
  Eigen::Vector2d grid_origin_ = Eigen::Vector2d::Zero();
  int grid_width_ = 0, grid_height_ = 0;
  std::vector<std::int32_t> cell_start_;  ///< per cell, into near_; one more than there are cells
  std::vector<std::int32_t> near_;        ///< columns within reach of each cell
  ColumnArrays arrays_;                   ///< the same, place by place
  mutable std::vector<float> bounds_m_;   ///< scratch memory of clearance_m()
};

}  // namespace understory
