#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "perception/stereo_rig.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// What was true at every physics step of one flight, so that many estimators can be given its sensors'
/// samples without flying again.
struct RecordedFlight {
  Scenario scenario;
  StereoRig rig;
  std::vector<Obstacle> obstacles;
  std::vector<Truth> truths;  ///< by step
  std::int64_t release_step = 0;
  FlightResult result;
};

/// Flies `scenario` on true depth (no image is rendered) and keeps the truth. By default on the true state
/// too, so that no estimate decides anything; on the filter, the flight is what its errors made of it. Leaves
/// no file. Throws as fly() does.
RecordedFlight recorded_flight(const Scenario& scenario, const std::filesystem::path& models_folder,
                               StateKind flown_on = StateKind::truth);

}  // namespace understory
