#pragma once

#include "perception/perception_config.hpp"

namespace understory {

class FieldVisitor;

/// How the aircraft under the path follower answers commands, and the envelope it keeps. The planner's flight
/// model and the path follower both read these numbers, so that the aircraft flies as planned.
struct FlightModelConfig {
  double cruise_speed_mps = 12.0;
  double maximum_angle_of_attack_rad = 0.4363;
  double minimum_angle_of_attack_rad = -0.05;
  double minimum_speed_mps = 8.0;
  double bank_gain_per_s = 9.0;
  double maximum_roll_rate_radps = 7.5;
  double maximum_differential_rad = 0.50;
  double roll_time_s = 0.06;
  double angle_of_attack_time_s = 0.22;
  double climb_angle_time_s = 0.45;
  double speed_gain_n_per_mps = 2.0;
};

/// Time constants of the inner loops. The outer laws (bank to roll rate, climb to angle of attack, speed to
/// thrust) are those of the flight model, so that the aircraft answers as planned.
struct PathFollowerConfig {
  double pitch_time_s = 0.05;
  double angle_of_attack_time_s = 0.09;
  double roll_time_s = 0.05;
};

/// How the planner turns remembered points into upright columns with a size.
struct ObstacleFieldConfig {
  double cell_m = 0.15;
  double column_gap_m = 1.2;
  double vertical_reach_m = 0.4;
  double trunk_m = 1;
  double sigma_zero_m = 0.05;
  double sigma_per_m = 0.010;
  double sigma_maximum_m = 0.3;
  double half_span_m = 0.4318;
  double wing_radius_m = 0.09;
};

/// The cost of a trajectory and its limits. Costs are dimensionless, per second of flight.
struct TrajectoryConfig {
  double step_s = 0.02;
  double horizon_m = 14.0;
  double minimum_clearance_m = -0.05;
  double minimum_kept_clearance_m = -0.08;
  double comfortable_clearance_m = 0.6;
  double clearance_weight = 15.0;
  double bank_weight = 1.0;
  double heading_weight = 9.0;
  double altitude_weight = 1.0;
  double band_weight = 40.0;
  double band_margin_m = 0.8;
  double slow_weight = 2.0;
  double final_heading_weight = 4.0;
  double heading_gain = 1.6;
  double maximum_course_bank_rad = 0.6;
  double altitude_gain_per_s = 1.2;
  double maximum_climb_mps = 2.0;
};

/// The tree of manoeuvres that OMPL grows with SST, RRT or EST in the space of bank and climb commands over
/// time.
struct ManoeuvreSearchConfig {
  int iterations = 600;
  double maximum_bank_rad = 1.57;
  double minimum_climb_mps = -1.5;
  double maximum_climb_mps = 2.0;
  double minimum_part_s = 0.08;
  double maximum_part_s = 0.48;
  int maximum_parts = 4;
  double hint_share = 0.3;
  double extreme_share = 0.2;
  double selection_radius = 0.6;
  double pruning_radius = 0.15;
};

/// Random changes to a manoeuvre that are kept where they lower its cost. A tree of random commands finds a
/// way, but seldom the best version of it.
struct ManoeuvreImprovementConfig {
  int iterations = 60;
  double bank_sigma_rad = 0.35;
  double climb_sigma_mps = 0.6;
  double duration_sigma_s = 0.08;
  double maximum_bank_rad = 1.57;
};

struct PlannerConfig {
  double kept_cost_ratio = 1.3;
  double change_cost_ratio = 1.5;
  int refresh_replans = 12;
  double refresh_s = 1;
  ObstacleFieldConfig field;
  TrajectoryConfig trajectory;
  ManoeuvreSearchConfig search;
  ManoeuvreImprovementConfig improvement;
};

/// The planner `library` (Barry, Florence & Tedrake 2018 flew one): manoeuvres made before the flight.
struct ManoeuvreLibraryConfig {
  double safe_clearance_m = 0.3;
};

void visit_fields(FieldVisitor& visit, ManoeuvreLibraryConfig& config);

/// What a plan costs the aircraft's computer, in simulated time: for each point of the map and for each step
/// of the flight model. Zero: a plan is ready after plan_latency_s whatever it takes.
struct PlanCost {
  double point_s = 0, step_s = 0;
};

struct AutopilotConfig {
  double launch_acceleration_mps2 = 30;
  double throttle_delay_s = 0.28;
  double plan_latency_s = 0.006;
  double straight_period_s = 0;
  double avoiding_period_s = 0;
  LocalMapConfig map;
  ResightingsConfig resightings;
  FlightModelConfig flight_model;
  PlannerConfig planner;
  PathFollowerConfig follower;
  PlanCost plan_cost;  ///< no key: from perception.compute
};

void visit_fields(FieldVisitor& visit, AutopilotConfig& config);

}  // namespace understory
