#pragma once

#include <limits>
#include <vector>

#include "planning/flight_model.hpp"
#include "planning/mission.hpp"
#include "planning/obstacle_field.hpp"
#include "planning/plan.hpp"

namespace understory {

/// Commands, each held for a time, one after the other. After the last one the course guidance takes over:
/// level out, turn back to the course's heading, return to the cruise altitude.
struct ManoeuvrePart {
  FlightCommand command;
  double duration_s = 0;
};
using Manoeuvre = std::vector<ManoeuvrePart>;

/// How trajectories are judged. Costs are dimensionless, per second of flight. A clearance of zero costs
/// `clearance_weight`.
struct TrajectoryConfig {
  double step_s = 0.02;
  double horizon_m = 14.0;             ///< distance ahead that plans cover: detection depth and some
  double minimum_clearance_m = -0.05;  ///< hard, for plans to be found
  double minimum_kept_clearance_m =
      -0.08;  ///< hard, for the plan in force: smaller, so that noise does not upset it
  double comfortable_clearance_m = 0.7;
  double clearance_weight = 15.0;
  double bank_weight = 1.0;           ///< per rad^2
  double heading_weight = 6.0;        ///< per rad^2 off the course: what lies to the side was not looked at
  double altitude_weight = 1.0;       ///< per m^2 off the cruise altitude
  double band_weight = 40.0;          ///< per m^2 beyond the band's margin
  double band_margin_m = 0.8;         ///< kept from the band's limits
  double slow_weight = 2.0;           ///< per (m/s)^2 below 1 m/s less than cruise
  double final_heading_weight = 4.0;  ///< per rad^2 at the horizon
  double heading_gain = 1.6;          ///< bank per heading error, course guidance
  double maximum_course_bank_rad = 0.6;
  double altitude_gain_per_s = 1.2;  ///< climb per altitude error
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

/// Everything by which trajectories are judged during one replan.
struct FlightTask {
  const FlightModel& model;
  const TrajectoryConfig& config;
  const Mission& mission;
  const ObstacleField& field;
  Eigen::Vector3d origin_world;  ///< where the plan starts: the horizon counts from here
};

/// The command that brings the aircraft back on course from `state`.
FlightCommand course_command(const FlightTask& task, const FlightState& state);
/// Cost per second of being in `state`, `clearance_m` from the nearest obstacle.
double cost_rate(const FlightTask& task, const FlightState& state, double clearance_m);
double final_cost(const FlightTask& task, const FlightState& state);
/// Distance inside the altitude band, negative outside.
double band_clearance_m(const FlightTask& task, const FlightState& state);
/// Distance made good along the course since the plan's start.
double progress_m(const FlightTask& task, const Eigen::Vector3d& position_world);

/// A clearance beyond this one changes no decision and no cost, where `minimum_clearance_m` is required.
double maximum_clearance_m(const TrajectoryConfig& config, double minimum_clearance_m);

/// A manoeuvre flown in the model to the horizon.
struct Rollout {
  double cost = 0;
  /// From obstacles, over the whole rollout (up to where it stopped), at most maximum_clearance_m().
  double minimum_clearance_m = 3.0;
  double minimum_margin_m =
      3.0;  ///< the same, or the distance to the altitude band's limits where that is less
  bool reached_horizon = false;   ///< false: came nearer than `minimum_clearance_m` or left the band before
  double free_until_s = 0;        ///< time at which it came too near, or its whole length
  std::vector<PlanPoint> points;  ///< filled where asked for
};

/// Flies `manoeuvre` from `start` in the model. Stops where the clearance falls below `minimum_clearance_m`,
/// unless `stop_when_too_near` is false. Stops also where the cost exceeds `maximum_cost`, since costs only
/// grow. `keep_points` returns the trajectory, every step.
Rollout fly_out(const FlightTask& task, const FlightState& start, const Manoeuvre& manoeuvre,
                double minimum_clearance_m, bool keep_points, bool stop_when_too_near = true,
                double maximum_cost = std::numeric_limits<double>::infinity());

}  // namespace understory
