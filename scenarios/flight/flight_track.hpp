#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "planning/plan.hpp"
#include "scenarios/flight/flight.hpp"

namespace understory {

/// One moment of a flight. World frame, m, rad, s.
struct TrackMoment {
  double t_s = 0;
  Eigen::Isometry3d T_world_true = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_world_estimated = Eigen::Isometry3d::Identity();
  double speed_mps = 0, estimated_speed_mps = 0;  ///< over ground
  double estimated_altitude_m = 0;
  double bank_rad = 0, estimated_bank_rad = 0, commanded_bank_rad = 0;  ///< right wing down positive
  double left_elevon_rad = 0, right_elevon_rad = 0;
  double clearance_m = 0;                                          ///< true; +infinity without obstacles
  Eigen::Vector3d position_error_world = Eigen::Vector3d::Zero();  ///< estimate less truth
  Eigen::Vector3d position_sigma_world = Eigen::Vector3d::Zero();  ///< as the estimator believes
  int hits = 0;                                                    ///< in the newest frame
};

/// A frame that the autopilot looked at.
struct TrackFrame {
  std::int64_t t_ns = 0;                ///< of the exposure
  Truth truth;                          ///< then
  std::size_t first_hit = 0, hits = 0;  ///< in FlightTrack::hits_world
};

/// A point of the map, for as long as it lay where it lay.
struct TrackPoint {
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  double from_s = 0, to_s = 0;
};

struct TrackPlan {
  double from_s = 0;  ///< in force from then on
  PlanOrigin origin = PlanOrigin::straight;
  std::vector<Eigen::Vector3d> way_world;
  double clearance_m = 0;  ///< as in Plan
};

/// A flight over time, for people who look at it afterwards.
struct FlightTrack {
  std::vector<TrackMoment> moments;  ///< 120 a second, and the last
  std::vector<TrackFrame> frames;
  std::vector<Eigen::Vector3d> hits_world;  ///< placed by the true pose
  std::vector<TrackPoint> points;           ///< in order of from_s
  std::vector<TrackPlan> plans;
  double launch_s = 0;  ///< when the aircraft left the catapult
};

/// Collects it.
class TrackRecorder : public FlightObserver {
 public:
  const char* stage() const override { return "track"; }
  void on_frame(const Flight& flight) override;
  void on_step(const Flight& flight) override;
  /// Adds the last moment. Once, when the flight has ended.
  FlightTrack finish(const Flight& flight);

 private:
  void follow_map(const Flight& flight);

  FlightTrack track_;
  std::vector<std::size_t> remembered_;  ///< of track_.points, in order of their positions
  std::int64_t plan_t_ns_ = -1;
  bool launched_ = false;
};

/// Of now.
TrackMoment moment_of(const Flight& flight);

/// The plan now in force, in the world of the estimate as the map has it.
std::vector<Eigen::Vector3d> planned_way_world(const Flight& flight);

}  // namespace understory
