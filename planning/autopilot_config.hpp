#pragma once

#include "perception/perception_config.hpp"

namespace understory {

/// How the path follower answers commands, and the envelope it keeps. The reduced model and the path follower
/// both read these numbers, so that what is planned is what is flown.
struct FlightModelConfig {
  double cruise_speed_mps = 12.0;  ///< held by the throttle
  double maximum_angle_of_attack_rad =
      0.4363;  ///< 25 deg: flat plates never stall, real wings do (our assumption)
  double minimum_angle_of_attack_rad = -0.05;  ///< the nose is not pushed down further
  double minimum_speed_mps = 8.0;  ///< level flight ends here: below it the nose is not pulled up further
  double bank_gain_per_s = 9.0;    ///< roll rate asked for per radian of bank error
  double maximum_roll_rate_radps = 7.5;    ///< at the reference speed 12.27 m/s; falls with speed
  double maximum_differential_rad = 0.50;  ///< elevon deflection to either side of the mean, for rolling
  double roll_time_s = 0.06;               ///< lag of the roll rate behind what is asked
  double angle_of_attack_time_s = 0.17;    ///< lag of the angle of attack
  double climb_angle_time_s = 0.45;        ///< how fast a climb angle error is taken out
  double speed_gain_n_per_mps = 2.0;       ///< throttle per speed error
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

/// Gains of the inner loops. The outer laws (bank to roll rate, climb to angle of attack, speed to thrust)
/// are those of the flight model, so that the aircraft answers as planned.
struct PathFollowerConfig {
  double pitch_time_s = 0.05;            ///< in which a pitch rate error is taken out
  double angle_of_attack_time_s = 0.09;  ///< in which an angle of attack error is taken out
  double roll_time_s = 0.05;             ///< in which a roll rate error is taken out
};

template <typename Visitor>
void visit_fields(Visitor& visit, PathFollowerConfig& config) {
  visit("pitch_time_s", config.pitch_time_s, 0.005, 1.0);
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.005, 1.0);
  visit("roll_time_s", config.roll_time_s, 0.005, 1.0);
}

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

/// How trajectories are judged. Costs are dimensionless, per second of flight. A clearance of zero costs
/// `clearance_weight`.
struct TrajectoryConfig {
  double step_s = 0.02;                ///< between the places of a rollout
  double horizon_m = 14.0;             ///< distance ahead that plans cover: detection depth and some
  double minimum_clearance_m = -0.05;  ///< hard, for plans to be found
  double minimum_kept_clearance_m =
      -0.08;  ///< hard, for the plan in force: smaller, so that noise does not upset it
  double comfortable_clearance_m = 0.7;  ///< below it clearance costs
  double clearance_weight = 15.0;        ///< at contact; none from the comfortable clearance on
  double bank_weight = 1.0;              ///< per rad^2
  double heading_weight = 6.0;        ///< per rad^2 off the course: what lies to the side was not looked at
  double altitude_weight = 1.0;       ///< per m^2 off the cruise altitude
  double band_weight = 40.0;          ///< per m^2 beyond the band's margin
  double band_margin_m = 0.8;         ///< kept from the band's limits
  double slow_weight = 2.0;           ///< per (m/s)^2 below 1 m/s less than cruise
  double final_heading_weight = 4.0;  ///< per rad^2 at the horizon
  double heading_gain = 1.6;          ///< bank per heading error, course guidance
  double maximum_course_bank_rad = 0.6;  ///< of the course guidance
  double altitude_gain_per_s = 1.2;      ///< climb per altitude error
  double maximum_climb_mps = 2.0;        ///< climb or descent of the course guidance
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

/// The tree of manoeuvres that OMPL grows (SST, RRT or EST, in the space of bank and climb commands over time).
struct ManoeuvreSearchConfig {
  int iterations = 600;             ///< extensions tried; never a time, so that runs repeat
  double maximum_bank_rad = 1.57;   ///< a wing on edge passes where a level one does not
  double minimum_climb_mps = -1.5;  ///< lower end of the climb commands tried
  double maximum_climb_mps = 2.0;   ///< upper end
  double minimum_part_s = 0.08;     ///< shortest duration of a command
  double maximum_part_s = 0.48;     ///< longest
  int maximum_parts = 4;            ///< commands in a row before the course guidance takes over
  double hint_share = 0.3;          ///< of the commands tried: near those of the plan in force
  double extreme_share = 0.2;       ///< of the commands tried: with the maximum bank, to either side
  double selection_radius = 0.6;    ///< SST's, in the search's metric (squared_distance())
  double pruning_radius = 0.15;     ///< SST's: nearer nodes of higher cost go
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

/// Random descent around a manoeuvre. A tree of random commands finds a way, but seldom its best version.
struct ManoeuvreImprovementConfig {
  int iterations = 60;             ///< rollouts tried
  double bank_sigma_rad = 0.35;    ///< of the change to one part's bank
  double climb_sigma_mps = 0.6;    ///< of the change to its climb
  double duration_sigma_s = 0.08;  ///< of the change to its duration
  double maximum_bank_rad = 1.57;  ///< changes end there
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
  bool use_ompl = true;  ///< false: the fallback primitives alone answer when the straight way is blocked
  /// A plan in force whose cost has not grown past this share of its cost when new is kept without a search.
  double kept_cost_ratio = 1.3;
  double change_cost_ratio =
      1.5;                   ///< another way must be this much cheaper than the plan in force: no dithering
  int refresh_replans = 12;  ///< a kept plan is searched against anew after this many replans,
  double refresh_s = 1;      ///< or after this long
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

/// The planner `library`: manoeuvres made beforehand, the one with the greatest clearance first.
struct ManoeuvreLibraryConfig {
  double safe_clearance_m = 0.3;  ///< the manoeuvre in force is flown on while its rest keeps this much
};

template <typename Visitor>
void visit_fields(Visitor& visit, ManoeuvreLibraryConfig& config) {
  visit("safe_clearance_m", config.safe_clearance_m, 0.0, 3.0);
}

struct AutopilotConfig {
  double launch_acceleration_mps2 =
      30;  ///< two IMU samples in a row above this along body x: the catapult has fired
  double throttle_delay_s = 0.28;  ///< from then to throttle and control; the rail takes 0.25 s of it
  double plan_latency_s = 0.006;   ///< what computing a plan costs in simulated time, before it takes effect
  /// Longest between plans while the one in force goes straight and nothing new comes near it; what does is
  /// planned for at once. 0: plans at every call of replan(), as far as plan_latency_s lets it.
  double straight_period_s = 0;
  double avoiding_period_s = 0;  ///< the same while the plan in force goes around something
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
