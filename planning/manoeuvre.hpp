#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "planning/autopilot_config.hpp"
#include "planning/flight_model.hpp"
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

struct ImprovedManoeuvre {
  Manoeuvre manoeuvre;
  double cost = 0;  ///< of its rollout; infinite where that does not reach the horizon
};

/// The cheapest variant found that reaches the horizon with `minimum_clearance_m`; `manoeuvre` itself where
/// no variant is cheaper or reaches the horizon. Repeats exactly for equal arguments.
ImprovedManoeuvre improve_manoeuvre(const FlightTask& task, const FlightState& start,
                                    const Manoeuvre& manoeuvre, double minimum_clearance_m,
                                    const ManoeuvreImprovementConfig& config, std::uint64_t seed);

}  // namespace understory
