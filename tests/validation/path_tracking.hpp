#pragma once

#include "planning/path_follower.hpp"
#include "tests/validation/replay.hpp"

namespace understory {

/// How a flown path is held: the acceleration across it that the path itself has, called for early by what
/// the aircraft lags behind, and what brings the aircraft back as a damped swing. The bank points the lift
/// along the sum of this acceleration and gravity's opposite, the climb command makes its upward part.
struct TrackingConfig {
  double lead_s = 0.20;  ///< input delay 0.02 s, lag of the angle of attack 0.17 s, and half a control period
  double swing_radps = 3.0;  ///< slower than the bank loop (9 rad/s), faster than the jog
  double damping = 1.0;      ///< critical: no swinging through the path
  FlightModelConfig flight_model;
  PathFollowerConfig follower;
};

/// The command that keeps to the record's path at `t_s` of it.
FlightCommand tracking_command(const FlightModel& model, const TrackingConfig& config,
                               const FlightRecord& record, const State& state, double t_s);

/// The record's path flown by the path follower, which sees the true state at 200 Hz, from the recorded
/// start.
Replay track(const FreeFlight& air, const Airframe& airframe, const TrackingConfig& config,
             const FlightRecord& record);

/// Distance of a point to the record's path (straight between its moments), wherever on it the aircraft is.
double distance_to_path_m(const FlightRecord& record, const Eigen::Vector3d& position_world);

}  // namespace understory
