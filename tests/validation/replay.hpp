#pragma once

#include <vector>

#include "tests/validation/flight_record.hpp"
#include "tests/validation/free_flight.hpp"

namespace understory {

/// Where the simulated aircraft was at a recorded moment, relative to its start.
struct ReplayedMoment {
  double t_s = 0;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Zero();
};
ReplayedMoment replayed_moment(const Truth& truth, double t_s);
using Replay = std::vector<ReplayedMoment>;

/// The recorded inputs flown open loop from the recorded start: one moment for each of the record's.
Replay replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record);

/// Simulated less recorded.
struct ReplayError {
  double t_s = 0;
  double horizontal_m = 0;
  double height_m = 0;
  double roll_rad = 0;
  double pitch_rad = 0;
  double yaw_rad = 0;
};
std::vector<ReplayError> errors(const Replay& flown, const FlightRecord& record);

double rms_roll_rad(const std::vector<ReplayError>& all);
double maximum_horizontal_m(const std::vector<ReplayError>& all);
double maximum_height_m(const std::vector<ReplayError>& all);
/// The error at the moment nearest to `t_s`.
const ReplayError& error_at(const std::vector<ReplayError>& all, double t_s);

}  // namespace understory
