#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "perception/stereo_rig.hpp"
#include "scenarios/scenario.hpp"
#include "sim/obstacle.hpp"
#include "sim/truth.hpp"

namespace understory {

/// What was true at every physics step of one flight, so that many estimators can be given its sensors'
/// samples without flying again.
struct RecordedFlight {
  Scenario scenario;
  StereoRig rig;
  std::vector<Obstacle> obstacles;
  std::vector<Truth> truths;  ///< by step
  std::int64_t release_step = 0;
};

/// Flies `scenario` on true depth and true state (no image is rendered, no estimate decides anything) and
/// keeps the truth. Leaves no file. Throws as fly() does.
RecordedFlight recorded_flight(const Scenario& scenario, const std::filesystem::path& models_folder);

}  // namespace understory
