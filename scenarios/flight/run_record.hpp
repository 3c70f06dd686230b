#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// What a flight may leave in its folder: all names; and with the manifest of this one.
extern const std::vector<std::string> run_patterns;
FolderContents run_contents(const Scenario& scenario);

/// Collects what a flight leaves behind and scores it. Works in memory; write() makes the run folder's files,
/// each whole or not at all, result.json last.
class RunRecord : public FlightObserver {
 public:
  void on_frame(const Flight& flight) override;
  void on_step(const Flight& flight) override;

  const FlightResult& so_far() const { return result_; }
  /// Closes the sums and the digest. Once, when the flight has ended.
  FlightResult finish(const Flight& flight);

  /// trajectory.csv, truth.tum, estimate.tum, map.ply, obstacles.csv and result.json into `folder`.
  void write(const std::filesystem::path& folder) const;

 private:
  void add_path(const Flight& flight);
  void add_row(const Flight& flight);
  void add_errors(const Flight& flight);
  void add_points(const Flight& flight);
  void count_points_on_obstacles(const std::vector<Obstacle>& obstacles);

  FlightResult result_;
  RunDigest digest_;
  std::string trajectory_, true_path_, estimated_path_, obstacles_;
  std::vector<ObstaclePoint> points_;
  /// Of points_, seen from where the aircraft really was.
  std::vector<Eigen::Vector3d> true_positions_world_;
  std::optional<std::int64_t> released_ns_;
  Eigen::Vector3d last_position_world_ = Eigen::Vector3d::Zero();
  double position_error_sum_m_ = 0;
  double velocity_error_sum_mps_ = 0;
  std::int64_t error_count_ = 0;
};

}  // namespace understory
