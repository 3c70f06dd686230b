#pragma once

#include "perception/perception_config.hpp"

namespace understory {

/// How the aircraft under the path follower answers commands, and the envelope it keeps. The planner's flight
/// model and the path follower both read these numbers, so that the aircraft flies as planned.
struct FlightModelConfig {
  double cruise_speed_mps = 12.0;  ///< airspeed that the throttle holds; 12.8 m/s is the fastest level flight
  /// Largest angle of attack. 25 deg: a flat plate never stalls, a real wing does (our assumption).
  double maximum_angle_of_attack_rad = 0.4363;
  double minimum_angle_of_attack_rad = -0.05;  ///< smallest angle of attack to which the nose is pushed down
  double minimum_speed_mps = 8.0;              ///< airspeed below which the nose is not pulled up further
  double bank_gain_per_s = 9.0;                ///< commanded roll rate per bank error
  double maximum_roll_rate_radps = 7.5;        ///< largest roll rate at 12.27 m/s; it falls with the airspeed
  double maximum_differential_rad = 0.50;      ///< largest deflection from the mean of both elevons
  double roll_time_s = 0.06;                   ///< time constant with which the roll rate follows its command
  double angle_of_attack_time_s = 0.17;  ///< time constant with which the angle of attack follows its command
  double climb_angle_time_s = 0.45;      ///< time constant in which a climb angle error is corrected
  double speed_gain_n_per_mps = 2.0;     ///< thrust added per speed error
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
  double pitch_time_s = 0.05;            ///< time constant in which a pitch rate error is corrected
  double angle_of_attack_time_s = 0.09;  ///< time constant in which an angle of attack error is corrected
  double roll_time_s = 0.05;             ///< time constant in which a roll rate error is corrected
};

template <typename Visitor>
void visit_fields(Visitor& visit, PathFollowerConfig& config) {
  visit("pitch_time_s", config.pitch_time_s, 0.005, 1.0);
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.005, 1.0);
  visit("roll_time_s", config.roll_time_s, 0.005, 1.0);
}

/// How the planner turns remembered points into upright columns with a size.
struct ObstacleFieldConfig {
  double cell_m = 0.15;       ///< side of the horizontal cells; points of one cell become one upright column
  double column_gap_m = 1.2;  ///< gap in height between points of a cell at which a new column starts
  double vertical_reach_m = 0.4;  ///< length by which a column extends above and below its outermost points
  /// Columns reach down to the ground, as trees and posts do, so that the aircraft does not pass under the
  /// part of a trunk that it saw with its nose up. A false detection in the air then blocks every height: it
  /// pays in wind (docs/decisions/017).
  bool stands_on_ground = false;
  double sigma_zero_m = 0.05;    ///< uncertainty of a point when it is seen; the planner adds it to its size
  double sigma_per_m = 0.010;    ///< growth of that uncertainty per metre flown since (docs/sources.md [15])
  double sigma_maximum_m = 0.3;  ///< uncertainty of a point at which the growth ends
  double half_span_m = 0.4318;   ///< half the span of the wing that must pass
  double wing_radius_m = 0.09;   ///< radius of the capsule about the span: half the winglets' height
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
  double step_s = 0.02;     ///< time between the computed places of a trajectory
  double horizon_m = 14.0;  ///< distance ahead that a plan covers: the detection depth and some more
  double minimum_clearance_m = -0.05;  ///< smallest clearance that a new plan may have
  /// Smallest clearance at which the plan in force is kept; smaller than minimum_clearance_m, so that noise
  /// does not discard a plan.
  double minimum_kept_clearance_m = -0.08;
  double comfortable_clearance_m = 0.7;  ///< clearance from which on it costs nothing
  double clearance_weight = 15.0;        ///< cost at zero clearance; it falls to none at the comfortable one
  double bank_weight = 1.0;              ///< cost per rad^2 of bank
  double heading_weight = 6.0;           ///< cost per rad^2 of heading off the course: unseen ground
  double altitude_weight = 1.0;          ///< cost per m^2 off the cruise altitude
  double band_weight = 40.0;             ///< cost per m^2 within band_margin_m of the band's limits
  double band_margin_m = 0.8;         ///< distance from the altitude band's limits within which places cost
  double slow_weight = 2.0;           ///< cost per (m/s)^2 by which the airspeed is over 1 m/s below cruise
  double final_heading_weight = 4.0;  ///< cost per rad^2 of heading off the course at the end of the plan
  double heading_gain = 1.6;          ///< commanded bank per heading error while the course is held
  double maximum_course_bank_rad = 0.6;  ///< largest bank while the course is held
  double altitude_gain_per_s = 1.2;      ///< commanded climb per altitude error while the course is held
  double maximum_climb_mps = 2.0;        ///< largest climb or descent while the course is held
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

/// The tree of manoeuvres that OMPL grows (SST, Li, Littlefield & Bekris 2016, in the space of bank and climb
/// commands over time).
struct ManoeuvreSearchConfig {
  int iterations = 600;            ///< number of extensions that a search tries; no time, so that runs repeat
  double maximum_bank_rad = 1.57;  ///< largest bank command tried; on edge the wing needs least room
  double minimum_climb_mps = -1.5;  ///< lowest climb command tried; negative: a descent
  double maximum_climb_mps = 2.0;   ///< highest climb command tried
  double minimum_part_s = 0.08;     ///< shortest duration of one command
  double maximum_part_s = 0.48;     ///< longest duration of one command
  int maximum_parts = 4;            ///< largest number of commands before the course is held again
  double hint_share = 0.3;          ///< share of the commands tried that lie near those of the plan in force
  double extreme_share = 0.2;       ///< share of the commands tried that bank fully, to either side
  double selection_radius = 0.6;    ///< SST's selection radius, in the metric of manoeuvre_search.cpp
  double pruning_radius = 0.15;     ///< SST's pruning radius: nearer nodes of higher cost are dropped
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
  int iterations = 60;             ///< number of changed manoeuvres that are tried
  double bank_sigma_rad = 0.35;    ///< standard deviation of the change to one command's bank
  double climb_sigma_mps = 0.6;    ///< standard deviation of the change to one command's climb
  double duration_sigma_s = 0.08;  ///< standard deviation of the change to one command's duration
  double maximum_bank_rad = 1.57;  ///< largest bank that a change may reach
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
  bool use_ompl = true;  ///< searches with OMPL; false: chooses among simple manoeuvres
  /// A plan is kept without a search while its cost is below this multiple of its cost when it was new.
  double kept_cost_ratio = 1.3;
  /// A new way replaces the plan in force where the plan in force costs this many times as much.
  double change_cost_ratio = 1.5;
  int refresh_replans = 12;  ///< number of replans after which a kept plan is compared with a new search
  double refresh_s = 1;      ///< time after which a kept plan is compared with a new search
  ObstacleFieldConfig field;
  TrajectoryConfig trajectory;
  ManoeuvreSearchConfig search;
  ManoeuvreImprovementConfig improvement;
};

template <typename Visitor>
void visit_fields(Visitor& visit, PlannerConfig& config) {
  visit("use_ompl", config.use_ompl);
  visit("kept_cost_ratio", config.kept_cost_ratio, 1.0, 100.0);
  visit("change_cost_ratio", config.change_cost_ratio, 1.0, 100.0);
  visit("refresh_replans", config.refresh_replans, 1, 1000);
  visit("refresh_s", config.refresh_s, 0.0, 10.0);
  visit("field", config.field);
  visit("trajectory", config.trajectory);
  visit("search", config.search);
  visit("improvement", config.improvement);
}

struct AutopilotConfig {
  /// Acceleration along body x above which two IMU samples in a row mean that the catapult has fired.
  double launch_acceleration_mps2 = 30;
  /// Time from the detected launch until throttle and control begin; the rail takes 0.25 s of it.
  double throttle_delay_s = 0.28;
  double plan_latency_s = 0.006;  ///< simulated time that computing a plan takes
  /// Longest time between plans while the plan in force goes straight. A new obstacle near the way is planned
  /// for at once. 0: a plan at every replan, as far as plan_latency_s allows.
  double straight_period_s = 0;
  /// Longest time between plans while the plan in force avoids an obstacle. A new obstacle near the way is
  /// planned for at once. 0: a plan at every replan.
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
