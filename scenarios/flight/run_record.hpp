#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/state.hpp"
#include "perception/obstacle_point.hpp"
#include "perception/stereo_frame.hpp"
#include "planning/controls.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/flight/run_digest.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"

namespace understory {

/// Makes `folder`, removes the files that an earlier run left there, and writes scenario.yaml. Throws
/// ScenarioError where it cannot be written.
void prepare_run_folder(const Scenario& scenario, const std::filesystem::path& folder);

/// Collects what a flight leaves behind and scores it. Works in memory; write() makes the run folder's files,
/// each whole or not at all, result.json last.
class RunRecord {
 public:
  RunRecord(const Scenario& scenario, std::vector<Obstacle> obstacles);

  /// Every physics step: true path and true clearance. `released`: has left the catapult.
  void observe(const Truth& truth, bool released);
  /// At the rate of trajectory.csv (200 Hz): truth, estimate and controls side by side.
  void observe(const Truth& truth, const State& state, const Controls& controls, bool released);
  /// Every frame, images into the digest.
  void observe(const StereoFrame& frame, std::size_t hit_count);
  /// The map's points after a frame: keeps those that this frame brought in (not those it only saw again).
  /// `T_true_estimated`: what turns the estimator's world into the true one at the image's moment, so that
  /// points can be counted on true obstacles whatever the odometry frame has drifted until then.
  void remember_of_frame(const std::vector<ObstaclePoint>& points, std::int64_t t_ns,
                         const Eigen::Isometry3d& T_true_estimated);

  /// Fields the loop itself knows (replans, timings, ending) are set here directly.
  FlightResult& result() { return result_; }
  /// Closes the sums and the digest. Once, after the last observation.
  void finish(Ending ending);

  /// trajectory.csv, map.ply and result.json into `folder` (scenario.yaml is written before take-off).
  void write(const std::filesystem::path& folder) const;

 private:
  /// Reckoned once for each moment: both observations of a truth ask.
  double clearance_at(const Truth& truth);

  Scenario scenario_;
  std::vector<Obstacle> obstacles_;
  FlightResult result_;
  RunDigest digest_;
  std::string trajectory_;
  std::vector<ObstaclePoint> points_;
  std::vector<Eigen::Vector3d>
      true_positions_world_;  ///< of points_, seen from where the aircraft really was
  Truth last_truth_;
  double released_s_ = 0;
  double error_sum_m_ = 0;
  double velocity_error_sum_mps_ = 0;
  std::int64_t error_count_ = 0;
  std::int64_t steps_ = 0;
  std::int64_t clearance_t_ns_ = -1;  ///< the moment of the next
  double clearance_m_ = 0;
};

}  // namespace understory
