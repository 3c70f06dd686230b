#pragma once

#include "perception/perception_config.hpp"

namespace understory {

/// How the aircraft under the path follower answers commands, and the envelope it keeps. The planner's flight
/// model and the path follower both read these numbers, so that the aircraft flies as planned.
struct FlightModelConfig {
  double cruise_speed_mps = 12.0;  ///< airspeed that the throttle holds; 12.8 m/s is the fastest level flight
  /// Largest commanded angle of attack, 25 deg: the flat-plate model never stalls, but a real wing does (our
  /// assumption).
  double maximum_angle_of_attack_rad = 0.4363;
  double minimum_angle_of_attack_rad = -0.05;  ///< smallest commanded angle of attack
  /// airspeed at and below which the limit of the angle of attack is reduced to 60 %; the reduction begins
  /// 0.5 m/s above it
  double minimum_speed_mps = 8.0;
  double bank_gain_per_s = 9.0;  ///< commanded roll rate per radian of bank error
  /// largest commanded roll rate at 12.27 m/s; the limit is proportional to the airspeed
  double maximum_roll_rate_radps = 7.5;
  /// largest differential elevon deflection: that of each elevon from the mean of both
  double maximum_differential_rad = 0.50;
  double roll_time_s = 0.06;             ///< time constant with which the roll rate follows its command
  double angle_of_attack_time_s = 0.17;  ///< time constant with which the angle of attack follows its command
  double climb_angle_time_s = 0.45;      ///< time constant of the control loop for the climb angle
  double speed_gain_n_per_mps = 2.0;     ///< thrust added per m/s of airspeed below cruise_speed_mps
};

template <typename Visitor>
void visit_fields(Visitor& visit, FlightModelConfig& config) {
  visit("cruise_speed_mps", config.cruise_speed_mps, 8.0, 16.0);
  visit("maximum_angle_of_attack_rad", config.maximum_angle_of_attack_rad, 0.1, 0.8);
  visit("minimum_angle_of_attack_rad", config.minimum_angle_of_attack_rad, -0.5, 0.1);
  visit("minimum_speed_mps", config.minimum_speed_mps, 5.0, 12.0);
  visit("bank_gain_per_s", config.bank_gain_per_s, 1.0, 30.0);
  visit("maximum_roll_rate_radps", config.maximum_roll_rate_radps, 1.0, 20.0);
  visit("maximum_differential_rad", config.maximum_differential_rad, 0.05, 0.9);
  visit("roll_time_s", config.roll_time_s, 0.005, 0.5);
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.02, 1.0);
  visit("climb_angle_time_s", config.climb_angle_time_s, 0.1, 5.0);
  visit("speed_gain_n_per_mps", config.speed_gain_n_per_mps, 0.0, 20.0);
}

/// Time constants of the inner loops. The outer laws (bank to roll rate, climb to angle of attack, speed to
/// thrust) are those of the flight model, so that the aircraft answers as planned.
struct PathFollowerConfig {
  double pitch_time_s = 0.05;            ///< time constant of the control loop for the pitch rate
  double angle_of_attack_time_s = 0.09;  ///< time constant of the control loop for the angle of attack
  double roll_time_s = 0.05;             ///< time constant of the control loop for the roll rate
};

template <typename Visitor>
void visit_fields(Visitor& visit, PathFollowerConfig& config) {
  visit("pitch_time_s", config.pitch_time_s, 0.005, 1.0);
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.005, 1.0);
  visit("roll_time_s", config.roll_time_s, 0.005, 1.0);
}

/// How the planner turns remembered points into upright columns with a size.
struct ObstacleFieldConfig {
  /// side of the horizontal grid cells; the map points in one cell become one vertical column
  double cell_m = 0.15;
  /// height gap between the points of a cell above which they become separate columns
  double column_gap_m = 1.2;
  /// length by which a column extends above its highest and below its lowest point
  double vertical_reach_m = 0.4;
  /// Extends columns down to the ground, as trees and posts do, so that the aircraft does not fly below the
  /// part of a trunk that it has seen. A false detection in the air then blocks all heights below it, so it
  /// is worthwhile only in wind (docs/decisions/017).
  bool stands_on_ground = false;
  /// position uncertainty of a map point when it is detected; the planner enlarges obstacles by it
  double sigma_zero_m = 0.05;
  /// growth of a map point's position uncertainty per metre flown since its last detection (docs/sources.md
  /// [15])
  double sigma_per_m = 0.010;
  double sigma_maximum_m = 0.3;  ///< upper limit of a map point's position uncertainty
  double half_span_m = 0.4318;   ///< half of the wing span that the planner assumes
  /// radius of the capsule from wing tip to wing tip that represents the wing: half the winglets' height
  double wing_radius_m = 0.09;
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

/// The cost of a trajectory and its limits. Costs are dimensionless, per second of flight.
struct TrajectoryConfig {
  double step_s = 0.02;     ///< time step of a predicted trajectory
  double horizon_m = 14.0;  ///< distance along the course that a plan covers; more than the detection depth
  /// smallest clearance to obstacles and altitude limits that a new plan may have; negative: a small overlap
  /// is allowed
  double minimum_clearance_m = -0.05;
  /// Smallest clearance that the plan in force may have and still be kept. It is smaller than
  /// minimum_clearance_m, so that noise does not discard a plan.
  double minimum_kept_clearance_m = -0.08;
  double comfortable_clearance_m = 0.7;  ///< clearance beyond which the distance to obstacles adds no cost
  /// cost per second of flight at zero clearance to obstacles; it falls quadratically to 0 at
  /// comfortable_clearance_m
  double clearance_weight = 15.0;
  double bank_weight = 1.0;  ///< weight of the squared bank angle (in rad^2) in the cost per second of flight
  /// weight of the squared angle (in rad^2) between flight direction and course in the cost per second of
  /// flight; off the course lies unseen ground
  double heading_weight = 6.0;
  /// weight of the squared difference (in m^2) from the cruise altitude in the cost per second of flight
  double altitude_weight = 1.0;
  /// weight of the squared intrusion (in m^2) into the altitude margin band_margin_m in the cost per second
  /// of flight
  double band_weight = 40.0;
  double band_margin_m = 0.8;  ///< distance from the altitude limits within which band_weight adds cost
  /// weight of the squared airspeed deficit (in (m/s)^2) in the cost per second of flight; the deficit counts
  /// from 1 m/s below cruise_speed_mps
  double slow_weight = 2.0;
  /// weight of the squared angle (in rad^2) between flight direction and course in the cost at the end of a
  /// plan
  double final_heading_weight = 4.0;
  /// commanded bank per heading error while the aircraft follows the course without a manoeuvre
  double heading_gain = 1.6;
  /// largest commanded bank while the aircraft follows the course without a manoeuvre
  double maximum_course_bank_rad = 0.6;
  /// commanded climb rate per altitude error while the aircraft follows the course without a manoeuvre
  double altitude_gain_per_s = 1.2;
  /// largest commanded climb or sink rate while the aircraft follows the course without a manoeuvre
  double maximum_climb_mps = 2.0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, TrajectoryConfig& config) {
  visit("step_s", config.step_s, 0.005, 0.03);
  visit("horizon_m", config.horizon_m, 2.0, 60.0);
  visit("minimum_clearance_m", config.minimum_clearance_m, -1.0, 2.0);
  visit("minimum_kept_clearance_m", config.minimum_kept_clearance_m, -1.0, 2.0);
  visit("comfortable_clearance_m", config.comfortable_clearance_m, 0.0, 3.0);
  visit("clearance_weight", config.clearance_weight, 0.0, 1e4);
  visit("bank_weight", config.bank_weight, 0.0, 1e4);
  visit("heading_weight", config.heading_weight, 0.0, 1e4);
  visit("altitude_weight", config.altitude_weight, 0.0, 1e4);
  visit("band_weight", config.band_weight, 0.0, 1e4);
  visit("band_margin_m", config.band_margin_m, 0.0, 3.0);
  visit("slow_weight", config.slow_weight, 0.0, 1e4);
  visit("final_heading_weight", config.final_heading_weight, 0.0, 1e4);
  visit("heading_gain", config.heading_gain, 0.0, 10.0);
  visit("maximum_course_bank_rad", config.maximum_course_bank_rad, 0.05, 1.5);
  visit("altitude_gain_per_s", config.altitude_gain_per_s, 0.0, 10.0);
  visit("maximum_climb_mps", config.maximum_climb_mps, 0.0, 6.0);
}

/// The tree of manoeuvres that OMPL grows with SST, RRT or EST in the space of bank and climb commands over
/// time.
struct ManoeuvreSearchConfig {
  /// number of tree extensions per search; a count instead of a time limit, so that runs are repeatable
  int iterations = 600;
  /// largest bank that the search commands; with the wing vertical the aircraft needs the least width
  double maximum_bank_rad = 1.57;
  double minimum_climb_mps = -1.5;  ///< lowest climb rate that the search commands; negative: a descent
  double maximum_climb_mps = 2.0;   ///< highest climb rate that the search commands
  double minimum_part_s = 0.08;     ///< shortest duration of one command within a manoeuvre
  double maximum_part_s = 0.48;     ///< longest duration of one command within a manoeuvre
  /// largest number of commands in a manoeuvre; after the last the aircraft returns to its course
  int maximum_parts = 4;
  /// share of the random commands that are drawn near a command of the plan in force
  double hint_share = 0.3;
  double extreme_share = 0.2;  ///< share of the random commands that use the full bank, to either side
  /// SST's selection radius; distance 1 is 1 m, 0.3 rad of heading or 0.8 rad of bank
  double selection_radius = 0.6;
  /// SST's pruning radius: of nodes within it only the cheapest is kept; distance 1 is 1 m, 0.3 rad of
  /// heading or 0.8 rad of bank
  double pruning_radius = 0.15;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ManoeuvreSearchConfig& config) {
  visit("iterations", config.iterations, 1, 100000);
  visit("maximum_bank_rad", config.maximum_bank_rad, 0.1, 1.6);
  visit("minimum_climb_mps", config.minimum_climb_mps, -6.0, 0.0);
  visit("maximum_climb_mps", config.maximum_climb_mps, 0.0, 6.0);
  visit("minimum_part_s", config.minimum_part_s, 0.02, 1.0);
  visit("maximum_part_s", config.maximum_part_s, 0.02, 4.0);
  visit("maximum_parts", config.maximum_parts, 1, 6);
  visit("hint_share", config.hint_share, 0.0, 1.0);
  visit("extreme_share", config.extreme_share, 0.0, 1.0);
  visit("selection_radius", config.selection_radius, 0.0, 10.0);
  visit("pruning_radius", config.pruning_radius, 0.0, 10.0);
}

/// Random changes to a manoeuvre that are kept where they lower its cost. A tree of random commands finds a
/// way, but seldom the best version of it.
struct ManoeuvreImprovementConfig {
  int iterations = 60;           ///< number of random variants of a manoeuvre that are tried
  double bank_sigma_rad = 0.35;  ///< standard deviation of the random change to the bank of one command
  double climb_sigma_mps = 0.6;  ///< standard deviation of the random change to the climb rate of one command
  double duration_sigma_s = 0.08;  ///< standard deviation of the random change to the duration of one command
  double maximum_bank_rad = 1.57;  ///< largest bank of a command after a random change
};

template <typename Visitor>
void visit_fields(Visitor& visit, ManoeuvreImprovementConfig& config) {
  visit("iterations", config.iterations, 0, 100000);
  visit("bank_sigma_rad", config.bank_sigma_rad, 0.0, 3.0);
  visit("climb_sigma_mps", config.climb_sigma_mps, 0.0, 5.0);
  visit("duration_sigma_s", config.duration_sigma_s, 0.0, 1.0);
  visit("maximum_bank_rad", config.maximum_bank_rad, 0.1, 1.6);
}

struct PlannerConfig {
  /// When a new map point lies near it, the plan in force is kept without a search while its cost is at most
  /// this multiple of its original cost, plus 1.
  double kept_cost_ratio = 1.3;
  /// A newly found manoeuvre replaces a usable plan in force only if that plan costs more than this many
  /// times as much.
  double change_cost_ratio = 1.5;
  /// number of replans after which a plan that was kept is compared with a newly searched one
  int refresh_replans = 12;
  double refresh_s = 1;  ///< time after which a plan that was kept is compared with a newly searched one
  ObstacleFieldConfig field;
  TrajectoryConfig trajectory;
  ManoeuvreSearchConfig search;
  ManoeuvreImprovementConfig improvement;
};

template <typename Visitor>
void visit_fields(Visitor& visit, PlannerConfig& config) {
  visit("kept_cost_ratio", config.kept_cost_ratio, 1.0, 100.0);
  visit("change_cost_ratio", config.change_cost_ratio, 1.0, 100.0);
  visit("refresh_replans", config.refresh_replans, 1, 1000);
  visit("refresh_s", config.refresh_s, 0.0, 10.0);
  visit("field", config.field);
  visit("trajectory", config.trajectory);
  visit("search", config.search);
  visit("improvement", config.improvement);
}

/// The planner `library` (Barry, Florence & Tedrake 2018 flew one): manoeuvres made before the flight.
struct ManoeuvreLibraryConfig {
  /// Clearance to obstacles and altitude limits at which a way is safe. Planner library flies straight on, or
  /// keeps its manoeuvre, while that way is safe; else it takes the manoeuvre with the largest clearance.
  double safe_clearance_m = 0.3;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ManoeuvreLibraryConfig& config) {
  visit("safe_clearance_m", config.safe_clearance_m, 0.0, 3.0);
}

struct AutopilotConfig {
  /// The autopilot detects the launch when two IMU samples in a row exceed this specific force along body x.
  double launch_acceleration_mps2 = 30;
  /// Time from launch detection until thrust, control and planning begin. The aircraft is on the catapult's
  /// rail for about 0.25 s of it.
  double throttle_delay_s = 0.28;
  double plan_latency_s = 0.006;  ///< simulated time that computing a plan takes
  /// Longest time between plans while the current plan flies straight. A new map point near the planned path
  /// triggers a plan at once. 0: plans at replan_rate_hz, as far as plan_latency_s allows.
  double straight_period_s = 0;
  /// Longest time between plans while the current plan avoids an obstacle. A new map point near the planned
  /// path triggers a plan at once. 0: plans at replan_rate_hz, as far as plan_latency_s allows.
  double avoiding_period_s = 0;
  LocalMapConfig map;
  ResightingsConfig resightings;
  FlightModelConfig flight_model;
  PlannerConfig planner;
  PathFollowerConfig follower;
};

template <typename Visitor>
void visit_fields(Visitor& visit, AutopilotConfig& config) {
  visit("launch_acceleration_mps2", config.launch_acceleration_mps2, 5.0, 500.0);
  visit("throttle_delay_s", config.throttle_delay_s, 0.0, 2.0);
  visit("plan_latency_s", config.plan_latency_s, 0.0, 0.2);
  visit("straight_period_s", config.straight_period_s, 0.0, 1.0);
  visit("avoiding_period_s", config.avoiding_period_s, 0.0, 1.0);
  visit("map", config.map);
  visit("resightings", config.resightings);
  visit("flight_model", config.flight_model);
  visit("planner", config.planner);
  visit("follower", config.follower);
}

}  // namespace understory
