#include "scenarios/campaign/flown_row.hpp"

namespace understory {

FlightRow flown_row(const Scenario& scenario, const FlightResult& result) {
  FlightRow row;
  row.seed = result.seed;
  row.status = RunStatus::flown;
  row.outcome = word_for(result.ending);
  row.cruise_speed_mps = scenario.autopilot.autopilot.flight_model.cruise_speed_mps;
  row.square_metres_per_tree = scenario.forest.square_metres_per_tree;
  row.goal_m = scenario.goal_x_m();
  row.distance_m = result.distance_m;
  row.progress_m = result.progress_m;
  row.mean_speed_mps = result.mean_speed_mps;
  row.min_clearance_m = result.min_clearance_m;
  row.position_error_mean_m = result.position_error_mean_m;
  row.position_error_max_m = result.position_error_max_m;
  row.detections = result.detections;
  row.remembered_points = result.remembered_points;
  for (const auto& [bar, points] : result.points_on_obstacles)
    if (row.minimum_points_on_a_bar < 0 || points < row.minimum_points_on_a_bar)
      row.minimum_points_on_a_bar = points;
  row.planner = result.planner;
  row.simulated_s = result.simulated_s;
  row.digest = result.digest;
  return row;
}

}  // namespace understory
