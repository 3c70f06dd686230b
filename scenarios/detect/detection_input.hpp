#pragma once

#include <optional>

#include "perception/io/calibration_file.hpp"
#include "perception/io/stereo_recording.hpp"
#include "scenarios/detect/detection_run.hpp"
#include "scenarios/detect/posed_map.hpp"

namespace understory {

// What the options of a detection run mean for one recording. All throw ScenarioError, one line, where they
// do not fit it.

/// The rig the options name, or the EuRoC input's own; its size is that of the images.
CalibratedRig rig_for(const DetectionOptions& options, const StereoRecording& recording);

/// The rule, stretched to the rig's rows, and the settings over it.
DetectionConfig config_for(const DetectionOptions& options, const StereoRig& rig);

/// The map that the poses carry; nothing where the options name none.
std::optional<PosedMap> map_for(const DetectionOptions& options, const StereoRecording& recording,
                                const StereoRig& rig, const LocalMapConfig& config);

/// Pictures a second of a film of the recording: its own pace, within what players take.
double film_rate_hz(const StereoRecording& recording);

}  // namespace understory
