#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimation/samples.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "perception/obstacle_point.hpp"
#include "planning/airframe.hpp"
#include "planning/plan.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/aircraft.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// One moment of a flight: the truth, the estimate and the commands. `odometry` is the frame of the estimate,
/// in which the map lies; without drift it is the world.
struct LogMoment {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();  ///< true, as the next five
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  double left_elevon_rad = 0, right_elevon_rad = 0, thrust_n = 0;
  double clearance_m = 0;  ///< from the wing to the nearest obstacle; +infinity without obstacles
  Eigen::Isometry3d T_odometry_body = Eigen::Isometry3d::Identity();  ///< estimated, as the next four
  Eigen::Vector3d estimated_velocity_mps = Eigen::Vector3d::Zero();   ///< odometry's axes
  Eigen::Vector3d estimated_rate_body_radps = Eigen::Vector3d::Zero();
  double estimated_altitude_m = 0;                             ///< above the ground
  Eigen::Vector3d position_sigma_m = Eigen::Vector3d::Zero();  ///< as the estimator believes
  Controls controls;                                           ///< in force
  double commanded_bank_rad = 0;                               ///< right wing down positive
};

/// A frame that the autopilot looked at.
struct LogFrame {
  std::int64_t t_ns = 0;                                           ///< of the exposure
  std::int64_t arrival_ns = 0;                                     ///< when the autopilot had looked at it
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();  ///< true, at the exposure
  std::int64_t first_hit = 0, hits = 0;                            ///< in FlightLog::hits_camera
};

inline constexpr std::int64_t still_there_ns = std::numeric_limits<std::int64_t>::max();

/// A point of the map, for as long as it did not move. Seen again elsewhere it becomes another LogPoint.
struct LogPoint {
  ObstaclePoint point;  ///< in the odometry frame
  /// Its place relative to the true obstacles: computed with the true pose at which it was seen, because the
  /// odometry frame drifts.
  Eigen::Vector3d true_position_world = Eigen::Vector3d::Zero();
  std::int64_t from_ns = 0, to_ns = still_there_ns;
};

/// A plan from when it is in force on.
struct LogPlan {
  std::int64_t t_ns = 0;
  PlanOrigin origin = PlanOrigin::straight;
  std::vector<Eigen::Vector3d> way_odometry;
  double clearance_m = 0;  ///< as in Plan
};

/// A flight over time, complete: files, page, captions and log for viewers are made of it. It holds no
/// pointer into the flight.
struct FlightLog {
  Scenario scenario;
  CalibratedRig rig;
  std::vector<Obstacle> obstacles;
  AircraftShape aircraft;
  std::optional<std::int64_t> launch_ns;  ///< when the aircraft left the catapult
  std::vector<LogMoment> moments;         ///< 200 a second, and the last
  std::vector<LogFrame> frames;
  std::vector<Eigen::Vector3d> hits_camera;  ///< left camera's frame, of all frames
  std::vector<LogPoint> points;              ///< in order of from_ns
  std::vector<LogPlan> plans;
  Touch touch;  ///< what the aircraft touches at the end of the flight
  FlightResult result;
};

/// The moment in force at a time: the last that is not later, or the first.
const LogMoment& moment_at(const FlightLog& log, std::int64_t t_ns);
Eigen::Vector3d hit_world(const FlightLog& log, const LogFrame& frame, std::int64_t hit);
/// Right wing down positive.
double bank_rad(const Eigen::Isometry3d& T_world_body);
/// Estimate less truth, world axes.
Eigen::Vector3d position_error_m(const LogMoment& moment);

/// The log as the file flight.log of a run: numbers in steps of 0.1 mm, 1e-6 of a turn and so on, compressed.
/// The log that is read back is the same except for that rounding and the rig, which comes from the scenario.
/// Reading throws ScenarioError in one line if the file is not a log, is cut short or is another version's.
std::string to_bytes(const FlightLog& log);
FlightLog flight_log_from_bytes(const std::string& bytes, const std::string& name,
                                const std::filesystem::path& models_folder);

}  // namespace understory
