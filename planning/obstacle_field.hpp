#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "planning/flight_model.hpp"

namespace understory {

struct ObstacleFieldConfig {
  double cell_m = 0.15;       ///< points that share a horizontal cell of this size become one upright column
  double column_gap_m = 1.2;  ///< points of a cell farther apart in height than this start a new column
  double vertical_reach_m =
      0.4;  ///< a column stands out this far above and below its outermost points: trees go on
  /// What is seen in the air stands on the ground, as trees and posts do: columns reach down to height 0, and
  /// the aircraft does not pass under the part of a trunk that it saw with its nose up. What is wrongly seen
  /// in the air then stands in the way at every height: it pays in wind (docs/decisions/017).
  bool stands_on_ground = false;
  double sigma_zero_m = 0.05;  ///< uncertainty of a point when seen, added to its size
  double sigma_per_m =
      0.010;  ///< growth with the distance flown since: drift of the estimate (docs/sources.md [15])
  double sigma_maximum_m = 0.3;  ///< growth ends here
  double half_span_m = 0.4318;   ///< of the wing that must pass
  double wing_radius_m = 0.09;   ///< half the thickness of wing and winglets, as a capsule about the span
};

template <typename Visitor>
void visit_fields(Visitor& visit, ObstacleFieldConfig& config) {
  visit("cell_m", config.cell_m, 0.02, 1.0);
  visit("column_gap_m", config.column_gap_m, 0.1, 20.0);
  visit("vertical_reach_m", config.vertical_reach_m, 0.0, 10.0);
  visit("stands_on_ground", config.stands_on_ground);
  visit("sigma_zero_m", config.sigma_zero_m, 0.0, 2.0);
  visit("sigma_per_m", config.sigma_per_m, 0.0, 0.5);
  visit("sigma_maximum_m", config.sigma_maximum_m, 0.0, 2.0);
  visit("half_span_m", config.half_span_m, 0.0, 3.0);
  visit("wing_radius_m", config.wing_radius_m, 0.0, 1.0);
}

/// The remembered points for the planner: upright columns in a horizontal grid, which answer the free
/// distance to a wing in a given attitude. It is rebuilt for each replan. A search asks about ten thousand
/// times.
class ObstacleField {
 public:
  struct Column {
    Eigen::Vector2d centre_world;
    double bottom_m, top_m;
    double radius_m;  ///< half a cell and the points' uncertainty
  };

  /// Heights of `points` are above the ground. `maximum_asked_m`: the maximum clearance that will be asked
  /// for. A smaller one is cheaper.
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
  /// Columns within reach of each cell, with the data that exclude most of them.
  struct Near {
    Eigen::Vector2d centre_world;
    double around_m;  ///< the column's radius and the wing's
    std::int32_t column;
  };
  std::vector<Near> near_;
};

}  // namespace understory
