#pragma once

#include <filesystem>
#include <functional>

#include "estimation/samples.hpp"
#include "estimation/state.hpp"
#include "perception/stereo_frame.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

class StereoCameras;

/// Where a flight is, for a progress line.
struct FlightProgress {
  double simulated_s = 0;
  double wall_s = 0;
  double progress_m = 0;
  double goal_m = 0;
  double speed_mps = 0;
  double min_clearance_m = 0;
};

struct FlyOptions {
  std::filesystem::path models_folder;
  std::filesystem::path output_folder;  ///< made where missing; gets the run's files; empty: none are written
  bool video = false;                   ///< also flight.mp4 and still.png
  RendererKind renderer = RendererKind::osmesa;   ///< the machine's: not part of the scenario
  std::function<void(const Truth&)> on_truth;     ///< every physics step; may be empty
  std::function<void(const ImuSample&)> on_imu;   ///< as the stack gets it, faults included
  std::function<void(const State&)> on_estimate;  ///< at the IMU's rate, the step's samples taken in
  /// Every frame as it reaches the stack, with the cameras that took it, for the depth behind it. Not empty:
  /// images are rendered whatever the detector. What a hook does changes no flight.
  std::function<void(const StereoFrame&, StereoCameras&)> on_frame;
  std::function<void(const FlightProgress&)> on_progress;  ///< ten times per simulated second; may be empty
};

/// Flies a scenario once and leaves its run folder: scenario.yaml first, result.json last. Throws
/// ScenarioError for what a person gave wrongly (rig, folder) and MachineError where the machine fails (GL
/// library, disk). One flight per process: OMPL's generator is global (docs/decisions/001-determinism.md).
FlightResult fly(const Scenario& scenario, const FlyOptions& options);

}  // namespace understory
