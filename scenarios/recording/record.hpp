#pragma once

#include <cstdint>

#include "scenarios/fly.hpp"
#include "scenarios/recording/walk.hpp"
#include "scenarios/scenario.hpp"

namespace understory {

struct RecordedFlight {
  FlightResult result;
  std::int64_t frames = 0;
};

/// Flies `scenario` and leaves, beside the run's files, its recording in options.output_folder
/// (EurocRecording). The flight is the one that fly() flies. Throws as both do. Hooks of the caller's own are
/// replaced, but for on_progress.
RecordedFlight fly_recorded(const Scenario& scenario, FlyOptions options);

struct RecordedWalk {
  WalkPath path;
  double walked_s = 0;
  double walked_m = 0;
  std::int64_t frames = 0;
};

/// Carries the scenario's cameras and IMU past its obstacles, estimator and autopilot off, and leaves
/// scenario.yaml and the recording in options.output_folder: the truth as pose, no estimates. Every frame
/// arrives; a scenario's faults and lost frames are of flights. Ends at the goal plane or after time_limit_s.
/// Throws as walk_path and EurocRecording do.
RecordedWalk walk_recorded(const Scenario& scenario, const WalkConfig& config, const FlyOptions& options);

}  // namespace understory
