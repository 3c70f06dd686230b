#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// A way to carry a scenario's cameras and IMU.
struct Carriage {
  CalibratedRig rig;  ///< rig_of's
  std::vector<Obstacle> obstacles;
  std::function<Truth(std::int64_t t_ns)> truth_at;  ///< asked for in turn, step by step from 0
  std::int64_t end_ns = 0;                           ///< no step counts from here on
};

struct Carried {
  double carried_s = 0;
  double carried_m = 0;  ///< along the way
  std::int64_t frames = 0;
};

/// Estimator and autopilot off; leaves scenario.yaml and the recording (EurocRecording) in
/// options.output_folder: the truth as pose, no estimates. Every frame arrives: a scenario's faults and lost
/// frames are of flights. Throws as EurocRecording does.
Carried carry_recorded(const Scenario& scenario, const Carriage& carriage, const FlyOptions& options);

}  // namespace understory
