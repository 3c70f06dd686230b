#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_log.hpp"

namespace understory {

/// Keeps the log of a flight, scores it and takes its digest.
class FlightLogger : public FlightObserver {
 public:
  void on_frame(const Flight& flight) override;
  void on_step(const Flight& flight) override;
  void on_end(const Flight& flight) override;

  /// Of the flight until now; complete once it has ended.
  const FlightLog& log() const { return log_; }

 private:
  void begin(const Flight& flight);
  void add_path(const Flight& flight);
  void add_moment(const Flight& flight);
  void follow_map(const Flight& flight);
  void score(const LogMoment& moment);
  void count_points_on_obstacles();

  FlightLog log_;
  std::optional<ClearanceField> clearance_;
  RunDigest digest_;
  std::vector<std::size_t> remembered_;  ///< of log_.points: what the map holds, in its order
  std::int64_t plan_t_ns_ = -1;
  Eigen::Vector3d last_position_world_ = Eigen::Vector3d::Zero();
  double position_error_sum_m_ = 0;
  double velocity_error_sum_mps_ = 0;
  std::int64_t error_count_ = 0;
};

}  // namespace understory
