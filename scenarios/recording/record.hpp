#pragma once

#include <cstdint>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/recording/carried_path.hpp"
#include "scenarios/recording/recording.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

struct FlownRecording {
  FlightResult result;
  std::int64_t frames = 0;
};

/// Flies `scenario` and leaves, beside the run's files, its recording in options.output_folder
/// (recording_of). The flight is the one that fly() flies. Throws as both do.
FlownRecording fly_recorded(const Scenario& scenario, FlyOptions options, const RecordingChoice& choice = {});

/// A recording of carried cameras and IMU, without estimator and autopilot. Leaves scenario.yaml and the
/// recording (recording_of) in options.output_folder: the truth as pose, no estimates. Every frame arrives,
/// without the scenario's faults and lost frames.
struct Carried {
  double carried_s = 0;
  double carried_m = 0;  ///< along the way
  std::int64_t frames = 0;
};

struct RecordedWalk {
  WalkPath path;
  Carried carried;
};

/// Carries cameras and IMU past the scenario's obstacles on foot. Ends at the goal plane or after
/// time_limit_s. Throws as walk_path and recording_of do.
RecordedWalk walk_recorded(const Scenario& scenario, const WalkConfig& config, const FlyOptions& options,
                           const RecordingChoice& choice = {});

/// Carries cameras and IMU along `poses` of read_path, smoothly, from the first to the last, regardless of
/// obstacles. Time starts with the first pose; time_limit_s does not count. Throws as recording_of does.
Carried follow_recorded(const Scenario& scenario, const std::vector<TimedPose>& poses,
                        const FlyOptions& options, const RecordingChoice& choice = {});

}  // namespace understory
