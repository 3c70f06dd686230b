#include "planning/autopilot_config.hpp"

#include "perception/field_visitor.hpp"

namespace understory {

void visit_fields(FieldVisitor& visit, FlightModelConfig& config) {
  visit("cruise_speed_mps", config.cruise_speed_mps, 8.0, 16.0,
        "airspeed that the throttle holds; 12.8 m/s is the fastest level flight");
  visit("maximum_angle_of_attack_rad", config.maximum_angle_of_attack_rad, 0.1, 0.8,
        "Largest commanded angle of attack, 25 deg: the flat-plate model never stalls, but a real wing does "
        "(our assumption).");
  visit("minimum_angle_of_attack_rad", config.minimum_angle_of_attack_rad, -0.5, 0.1,
        "smallest commanded angle of attack");
  visit("minimum_speed_mps", config.minimum_speed_mps, 5.0, 12.0,
        "airspeed at and below which the limit of the angle of attack is reduced to 60 %; the reduction "
        "begins 0.5 m/s above it");
  visit("bank_gain_per_s", config.bank_gain_per_s, 1.0, 30.0, "commanded roll rate per radian of bank error");
  visit("maximum_roll_rate_radps", config.maximum_roll_rate_radps, 1.0, 20.0,
        "largest commanded roll rate at 12.27 m/s; the limit is proportional to the airspeed");
  visit("maximum_differential_rad", config.maximum_differential_rad, 0.05, 0.9,
        "largest differential elevon deflection: that of each elevon from the mean of both");
  visit("roll_time_s", config.roll_time_s, 0.005, 0.5,
        "time constant with which the roll rate follows its command");
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.02, 1.0,
        "time constant with which the angle of attack follows its command");
  visit("climb_angle_time_s", config.climb_angle_time_s, 0.1, 5.0,
        "time constant of the control loop for the climb angle");
  visit("speed_gain_n_per_mps", config.speed_gain_n_per_mps, 0.0, 20.0,
        "thrust added per m/s of airspeed below cruise_speed_mps");
}

void visit_fields(FieldVisitor& visit, PathFollowerConfig& config) {
  visit("pitch_time_s", config.pitch_time_s, 0.005, 1.0,
        "time constant of the control loop for the pitch rate");
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.005, 1.0,
        "time constant of the control loop for the angle of attack");
  visit("roll_time_s", config.roll_time_s, 0.005, 1.0, "time constant of the control loop for the roll rate");
}

void visit_fields(FieldVisitor& visit, ObstacleFieldConfig& config) {
  visit(
      "cell_m", config.cell_m, 0.02, 1.0,
      "side of the horizontal grid cells; the map points in one cell become one vertical column, or several");
  visit("column_gap_m", config.column_gap_m, 0.1, 20.0,
        "height gap between the points of a cell above which they become separate columns");
  visit("vertical_reach_m", config.vertical_reach_m, 0.0, 10.0,
        "length by which a column that is no trunk extends above its highest and below its lowest point");
  visit("trunk_m", config.trunk_m, 0.0, 10.0,
        "A column whose points reach over at least this height is taken for a trunk from the ground to a "
        "height of 50 m, seen or not; 0: none is. | docs/decisions/035");
  visit("sigma_zero_m", config.sigma_zero_m, 0.0, 2.0,
        "position uncertainty of a map point when it is detected; the planner enlarges obstacles by it");
  visit("sigma_per_m", config.sigma_per_m, 0.0, 0.5,
        "growth of a map point's position uncertainty per metre flown since its last detection | "
        "docs/sources.md [15]");
  visit("sigma_maximum_m", config.sigma_maximum_m, 0.0, 2.0,
        "upper limit of a map point's position uncertainty");
  visit("half_span_m", config.half_span_m, 0.0, 3.0, "half of the wing span that the planner assumes");
  visit(
      "wing_radius_m", config.wing_radius_m, 0.0, 1.0,
      "radius of the capsule from wing tip to wing tip that represents the wing: half the winglets' height");
}

void visit_fields(FieldVisitor& visit, TrajectoryConfig& config) {
  visit("step_s", config.step_s, 0.005, 0.03, "time step of a predicted trajectory");
  visit("horizon_m", config.horizon_m, 2.0, 60.0,
        "distance along the course that a plan covers; more than the farthest depth that the detector looks "
        "at");
  visit("minimum_clearance_m", config.minimum_clearance_m, -1.0, 2.0,
        "smallest clearance to obstacles and altitude limits that a new plan may have; negative: a small "
        "overlap is allowed");
  visit("minimum_kept_clearance_m", config.minimum_kept_clearance_m, -1.0, 2.0,
        "Smallest clearance that the plan in force may have and still be kept. It is smaller than "
        "minimum_clearance_m, so that noise does not discard a plan.");
  visit("comfortable_clearance_m", config.comfortable_clearance_m, 0.0, 3.0,
        "clearance beyond which the distance to obstacles adds no cost");
  visit("clearance_weight", config.clearance_weight, 0.0, 1e4,
        "cost per second of flight at zero clearance to obstacles; it falls quadratically to 0 at "
        "comfortable_clearance_m");
  visit("bank_weight", config.bank_weight, 0.0, 1e4,
        "weight of the squared bank angle (in rad^2) in the cost per second of flight");
  visit("heading_weight", config.heading_weight, 0.0, 1e4,
        "weight of the squared angle (in rad^2) between flight direction and course in the cost per second "
        "of flight; off the course lies unseen ground");
  visit(
      "altitude_weight", config.altitude_weight, 0.0, 1e4,
      "weight of the squared difference (in m^2) from the cruise altitude in the cost per second of flight");
  visit("band_weight", config.band_weight, 0.0, 1e4,
        "weight of the squared intrusion (in m^2) into the altitude margin band_margin_m in the cost per "
        "second of flight");
  visit("band_margin_m", config.band_margin_m, 0.0, 3.0,
        "distance from the altitude limits within which band_weight adds cost");
  visit("slow_weight", config.slow_weight, 0.0, 1e4,
        "weight of the squared airspeed deficit (in (m/s)^2) in the cost per second of flight; the deficit "
        "counts from 1 m/s below cruise_speed_mps");
  visit("final_heading_weight", config.final_heading_weight, 0.0, 1e4,
        "weight of the squared angle (in rad^2) between flight direction and course in the cost at the end "
        "of a plan");
  visit("heading_gain", config.heading_gain, 0.0, 10.0,
        "commanded bank per heading error while the aircraft follows the course without a manoeuvre");
  visit("maximum_course_bank_rad", config.maximum_course_bank_rad, 0.05, 1.5,
        "largest commanded bank while the aircraft follows the course without a manoeuvre");
  visit("altitude_gain_per_s", config.altitude_gain_per_s, 0.0, 10.0,
        "commanded climb rate per altitude error while the aircraft follows the course without a manoeuvre");
  visit("maximum_climb_mps", config.maximum_climb_mps, 0.0, 6.0,
        "largest commanded climb or sink rate while the aircraft follows the course without a manoeuvre");
}

void visit_fields(FieldVisitor& visit, ManoeuvreSearchConfig& config) {
  visit("iterations", config.iterations, 1, 100000,
        "number of tree extensions per search; a count instead of a time limit, so that runs are repeatable");
  visit("maximum_bank_rad", config.maximum_bank_rad, 0.1, 1.6,
        "largest bank that the search commands; with the wing vertical the aircraft needs the least width");
  visit("minimum_climb_mps", config.minimum_climb_mps, -6.0, 0.0,
        "lowest climb rate that the search commands; negative: a descent");
  visit("maximum_climb_mps", config.maximum_climb_mps, 0.0, 6.0,
        "highest climb rate that the search commands");
  visit("minimum_part_s", config.minimum_part_s, 0.02, 1.0,
        "shortest duration of one command within a manoeuvre");
  visit("maximum_part_s", config.maximum_part_s, 0.02, 4.0,
        "longest duration of one command within a manoeuvre");
  visit("maximum_parts", config.maximum_parts, 1, 6,
        "largest number of commands in a manoeuvre; after the last the aircraft returns to its course");
  visit("hint_share", config.hint_share, 0.0, 1.0,
        "share of the random commands that are drawn near a command of the plan in force");
  visit("extreme_share", config.extreme_share, 0.0, 1.0,
        "share of the random commands that use the full bank, to either side");
  visit("selection_radius", config.selection_radius, 0.0, 10.0,
        "SST's selection radius; distance 1 is 1 m, 0.3 rad of heading or 0.8 rad of bank");
  visit("pruning_radius", config.pruning_radius, 0.0, 10.0,
        "SST's pruning radius: of nodes within it only the cheapest is kept; distance 1 is 1 m, 0.3 rad of "
        "heading or 0.8 rad of bank");
}

void visit_fields(FieldVisitor& visit, ManoeuvreImprovementConfig& config) {
  visit("iterations", config.iterations, 0, 100000,
        "number of random variants of a manoeuvre that are tried");
  visit("bank_sigma_rad", config.bank_sigma_rad, 0.0, 3.0,
        "standard deviation of the random change to the bank of one command");
  visit("climb_sigma_mps", config.climb_sigma_mps, 0.0, 5.0,
        "standard deviation of the random change to the climb rate of one command");
  visit("duration_sigma_s", config.duration_sigma_s, 0.0, 1.0,
        "standard deviation of the random change to the duration of one command");
  visit("maximum_bank_rad", config.maximum_bank_rad, 0.1, 1.6,
        "largest bank of a command after a random change");
}

void visit_fields(FieldVisitor& visit, PlannerConfig& config) {
  visit("kept_cost_ratio", config.kept_cost_ratio, 1.0, 100.0,
        "When a new map point lies near it, the plan in force is kept without a search while its cost is at "
        "most this multiple of its original cost, plus 1.");
  visit("change_cost_ratio", config.change_cost_ratio, 1.0, 100.0,
        "A newly found manoeuvre replaces a usable plan in force only if that plan costs more than this many "
        "times as much.");
  visit("refresh_replans", config.refresh_replans, 1, 1000,
        "number of replans after which a plan that was kept is compared with a newly searched one");
  visit("refresh_s", config.refresh_s, 0.0, 10.0,
        "time after which a plan that was kept is compared with a newly searched one");
  visit("field", config.field);
  visit("trajectory", config.trajectory);
  visit("search", config.search);
  visit("improvement", config.improvement);
}

void visit_fields(FieldVisitor& visit, ManoeuvreLibraryConfig& config) {
  visit("safe_clearance_m", config.safe_clearance_m, 0.0, 3.0,
        "Clearance to obstacles and altitude limits at which a way is safe. Planner library flies straight "
        "on, or keeps its manoeuvre, while that way is safe; else it takes the manoeuvre with the largest "
        "clearance.");
}

void visit_fields(FieldVisitor& visit, AutopilotConfig& config) {
  visit("launch_acceleration_mps2", config.launch_acceleration_mps2, 5.0, 500.0,
        "The autopilot detects the launch when two IMU samples in a row exceed this specific force along "
        "body x.");
  visit("throttle_delay_s", config.throttle_delay_s, 0.0, 2.0,
        "Time from launch detection until thrust, control and planning begin. The aircraft is on the "
        "catapult's rail for about 0.25 s of it.");
  visit("plan_latency_s", config.plan_latency_s, 0.0, 0.2, "simulated time that computing a plan takes");
  visit("straight_period_s", config.straight_period_s, 0.0, 1.0,
        "Longest time between plans while the current plan flies straight. A new map point near the planned "
        "path triggers a plan at once. 0: plans at replan_rate_hz, as far as plan_latency_s allows.");
  visit("avoiding_period_s", config.avoiding_period_s, 0.0, 1.0,
        "Longest time between plans while the current plan avoids an obstacle. A new map point near the "
        "planned path triggers a plan at once. 0: plans at replan_rate_hz, as far as plan_latency_s allows.");
  visit("map", config.map);
  visit("resightings", config.resightings);
  visit("flight_model", config.flight_model);
  visit("planner", config.planner);
  visit("follower", config.follower);
}

}  // namespace understory
