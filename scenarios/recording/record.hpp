#pragma once

#include <cstdint>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/recording/carry.hpp"
#include "scenarios/recording/walk.hpp"
#include "scenarios/scenario/scenario.hpp"

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
  Carried carried;
};

/// Carries the scenario's cameras and IMU past its obstacles on foot (carry_recorded). Ends at the goal plane
/// or after time_limit_s. Throws as walk_path and EurocRecording do.
RecordedWalk walk_recorded(const Scenario& scenario, const WalkConfig& config, const FlyOptions& options);

/// Carries them along `poses` of read_path, smoothly, from the first to the last, whatever stands there. Time
/// starts with the first pose; time_limit_s does not count. Throws as EurocRecording does.
Carried follow_recorded(const Scenario& scenario, const std::vector<TimedPose>& poses,
                        const FlyOptions& options);

}  // namespace understory
