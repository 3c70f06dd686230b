#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "planning/airframe.hpp"
#include "tests/validation/free_flight.hpp"

namespace understory {

/// One moment of a flight of the real aircraft. World: x along the heading at the start, z up.
struct RecordedMoment {
  double t_s = 0;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< z as mended: see FlightRecord
  double roll_rad = 0;
  double pitch_rad = 0;  ///< positive nose down
  double yaw_rad = 0;
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Controls controls;
};

/// The real left jog of 2015-10-08 (tests/data/flight/README.md), its two known faults mended: rates
/// are turned back (done in the file), and height is the integral of the record's own velocities, which the
/// recorded z contradicts.
struct FlightRecord {
  std::vector<RecordedMoment> moments;  ///< evenly spaced

  AirborneStart start() const;
};

/// Throws ScenarioError, naming the file, where it is not such a record.
FlightRecord read_flight_record(const std::filesystem::path& file);

/// How far the recorded position strays horizontally from the integral of the recorded velocity.
double maximum_contradiction_m(const FlightRecord& record);

}  // namespace understory
