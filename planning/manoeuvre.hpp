#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
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
  Eigen::Vector3d origin_world;   ///< where the plan starts: the horizon counts from here
  std::int64_t* steps = nullptr;  ///< counts the model's steps, where somebody wants to know
  /// Along the course, over ground. Every step of every rollout asks for it.
  Eigen::Vector2d ahead{std::cos(mission.heading_rad), std::sin(mission.heading_rad)};
};

/// The command that brings the aircraft back on course from `state`.
FlightCommand course_command(const FlightTask& task, const FlightState& state);
/// Cost per second of being in `state`, `clearance_m` from the nearest obstacle.
double cost_rate(const FlightTask& task, const FlightState& state, double clearance_m);
double final_cost(const FlightTask& task, const FlightState& state);
/// A bound: no way from `state` to the horizon costs less, because a second costs at least 1 and no dive
/// makes the aircraft half as fast again.
double least_cost_to_go(const FlightTask& task, const FlightState& state);
/// Distance inside the altitude band, negative outside.
double band_clearance_m(const FlightTask& task, const FlightState& state);
/// Distance made good along the course since the plan's start.
double progress_m(const FlightTask& task, const Eigen::Vector3d& position_world);

/// A clearance beyond this one changes no decision and no cost if `minimum_clearance_m` is required.
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
  std::vector<PlanPoint> points;  ///< filled if requested
};

/// Flies `manoeuvre` from `start` in the model. Stops where the clearance falls below `minimum_clearance_m`,
/// unless `stop_when_too_near` is false. Stops also where the whole cost will exceed `maximum_cost`.
/// `keep_points` returns the trajectory, every step.
Rollout fly_out(const FlightTask& task, const FlightState& start, const Manoeuvre& manoeuvre,
                double minimum_clearance_m, bool keep_points, bool stop_when_too_near = true,
                double maximum_cost = std::numeric_limits<double>::infinity());

struct ImprovedManoeuvre {
  Manoeuvre manoeuvre;
  double cost = 0;  ///< of its rollout; infinite if that does not reach the horizon
};

/// The cheapest variant found that reaches the horizon with `minimum_clearance_m`; `manoeuvre` itself where
/// no variant is cheaper or reaches the horizon. Repeats exactly for equal arguments.
ImprovedManoeuvre improve_manoeuvre(const FlightTask& task, const FlightState& start,
                                    const Manoeuvre& manoeuvre, double minimum_clearance_m,
                                    const ManoeuvreImprovementConfig& config, std::uint64_t seed);

/// The part of the manoeuvre that is left after `elapsed_s`.
Manoeuvre rest_of(const Manoeuvre& manoeuvre, double elapsed_s);

/// Level, and turns of several banks to either side, held or reversed after a while.
std::vector<Manoeuvre> avoidance_primitives(double maximum_bank_rad);

/// Whether a point lies so near to the plan, over ground, that it changes the plan's cost.
bool is_near(const ObstaclePoint& point, const Plan& plan, const PlannerConfig& config);

/// Where a flight state lies in the search's space. Units are chosen so that one unit of each matters about
/// equally over the horizon: 1 m, 0.3 rad of heading, 0.8 rad of bank.
struct FlightPlace {
  Eigen::Vector3d position_world;
  double heading_rad, bank_rad;
};

inline FlightPlace place_of(const FlightState& state) {
  return {state.position_world, state.heading_rad, state.bank_rad};
}

inline double squared_distance(const FlightPlace& one, const FlightPlace& other) {
  const double heading = (one.heading_rad - other.heading_rad) / 0.3;
  const double bank = (one.bank_rad - other.bank_rad) / 0.8;
  return (one.position_world - other.position_world).squaredNorm() + heading * heading + bank * bank;
}

/// Places, numbered in the order they were added, and a linear search for the nearest. The answers and their
/// order are those of ompl::NearestNeighborsLinear. It is faster, because the places lie side by side in
/// memory, no distance is computed twice, and roots are taken only where they decide. Not thread safe, not
/// even to read.
class FlightPlaces {
 public:
  void clear() { places_.clear(); }
  void add(const FlightPlace& place) { places_.push_back(place); }
  /// The numbers of later places decrease by one.
  void remove(std::size_t number) { places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(number)); }
  std::size_t size() const { return places_.size(); }

  /// The first of those nearest to `place`; there must be one.
  std::size_t nearest(const FlightPlace& place) const;
  /// The `count` nearest, or all where they are fewer, nearest first.
  std::vector<std::size_t> nearest(const FlightPlace& place, std::size_t count) const;
  /// Those at most `radius` away, nearest first.
  std::vector<std::size_t> within(const FlightPlace& place, double radius) const;

 private:
  using Ranked = std::pair<double, std::size_t>;
  std::vector<std::size_t> numbers() const;

  std::vector<FlightPlace> places_;
  mutable std::vector<Ranked> ranked_;  ///< scratch memory
};

}  // namespace understory
