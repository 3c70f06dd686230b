#pragma once

#include <cstdint>
#include <vector>

#include "estimation/filter.hpp"
#include "perception/map/resightings.hpp"
#include "tests/validation/recorded_flight.hpp"

namespace understory {

/// What a pushbroom with several depths sees along a flight, frame by frame: every block of a trunk that
/// truly lies at a depth, put at the whole disparity's. Only the truth decides it, so one serves many trials.
struct Sightings {
  std::vector<double> depths_m;
  std::vector<std::int64_t> t_ns;  ///< of the frames
  std::vector<std::vector<StereoHit>> hits;
};

Sightings sightings(const RecordedFlight& flight, const std::vector<double>& depths_m);

/// What an estimator is given, beside the flight.
struct TrialConfig {
  FilterConfig filter;
  SensorsConfig sensors;
  std::vector<FaultConfig> faults;
  std::uint64_t sensor_seed = 1;
  /// Where given, and `resightings` on, the filter is told of obstacles seen again, one latency late.
  const Sightings* sightings = nullptr;
  ResightingsConfig resightings;
  /// The filter wakes up at the release, knowing pose and airspeed and nothing of the ground's: it takes the
  /// wind for zero, to within 3 m/s.
  bool ground_velocity_unknown = false;
};

/// Another filter from the same start.
void take_preset(TrialConfig& config, const FilterConfig& preset);

/// One moment of a trial, at the IMU's rate.
struct TrialMoment {
  Truth truth;
  State estimate;
  std::array<double, aid_count> innovations_squared{};  ///< of what arrived since the last moment; else nan
  std::array<bool, aid_count> faulty{};
};

/// Runs sensors, faults and filter along the recorded truth.
std::vector<TrialMoment> run_trial(const RecordedFlight& flight, const TrialConfig& config);

/// How the error of a remembered obstacle grew from its detection `sight_m` ahead to its passing.
struct Drift {
  double seen_s = 0;                                         ///< when it was detected
  Eigen::Vector2d along_across_m = Eigen::Vector2d::Zero();  ///< level, in the passing aircraft's course
  double vertical_m = 0;
  double total_m() const { return std::hypot(along_across_m.norm(), vertical_m); }
  /// Predicted one-sigma of the level part along and across by the filter's own covariance of position,
  /// grown between the two moments; 0 where it says nothing.
  double stated_sigma_m = 0;
};

/// A detection every 0.05 s from `from_s` after the release on, for as long as the passing is in the record.
std::vector<Drift> drifts(const RecordedFlight& flight, const std::vector<TrialMoment>& moments,
                          double sight_m, double from_s = 0.5);

/// Error of the estimate in the filter's coordinates. What the truth does not name as a state (biases) is
/// left zero.
ErrorVector error_of(const TrialMoment& moment);

}  // namespace understory
