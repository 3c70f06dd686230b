#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planning/airframe.hpp"
#include "tests/validation/free_flight.hpp"

namespace understory {

/// One moment of a flight, real or simulated. World: x along the heading at the start, z up, the start at the
/// origin.
struct FlightMoment {
  double t_s = 0;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Controls controls;

  double roll_rad() const;
  double pitch_rad() const;  ///< positive nose down
  double yaw_rad() const;
};

/// Evenly spaced.
using FlightRecord = std::vector<FlightMoment>;

/// The real left jog of 2015-10-08 (tests/data/flight/README.md), its two known faults mended: rates are
/// turned back (done in the file), and height is the integral of the record's own velocities, which the
/// recorded z contradicts.
FlightRecord real_left_jog();

/// How far the recorded position strays horizontally from the integral of the recorded velocity.
double maximum_contradiction_m(const FlightRecord& record);

AirborneStart start_of(const FlightRecord& record);
FlightMoment moment_of(const Truth& truth, double t_s);

/// The recorded inputs flown open loop from the recorded start: one moment for each of the record's.
FlightRecord replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);

/// Flown less recorded.
struct ReplayError {
  double t_s = 0;
  double horizontal_m = 0;
  double height_m = 0;
  double roll_rad = 0;
};
std::vector<ReplayError> errors(const FlightRecord& flown, const FlightRecord& record);

double rms_roll_rad(const std::vector<ReplayError>& all);
/// The largest of one of its members, whatever the sign.
double maximum_m(const std::vector<ReplayError>& all, double ReplayError::*member);
/// The error at the moment nearest to `t_s`.
const ReplayError& error_at(const std::vector<ReplayError>& all, double t_s);

}  // namespace understory
