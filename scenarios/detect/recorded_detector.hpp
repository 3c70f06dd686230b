#pragma once

#include <memory>
#include <string>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {

/// A detector of the table of parts for recorded, rectified pairs. Without a flight around it, it has no
/// truth.
class RecordedDetector {
 public:
  /// `name`: of the part, whose keys are in `config`. Throws ScenarioError if it uses no images.
  RecordedDetector(const VisionConfig& config, const std::string& name, const StereoRig& rig);
  RecordedDetector(const RecordedDetector&) = delete;
  RecordedDetector& operator=(const RecordedDetector&) = delete;

  ObstacleDetector& detector() { return *detector_; }
  /// What a pair costs the aircraft's computer, s.
  double cost_s() const;

 private:
  CalibratedRig rig_;
  Scenario scenario_;
  std::vector<Obstacle> no_obstacles_;
  TruthHistory truth_;
  std::unique_ptr<ObstacleDetector> detector_;
};

}  // namespace understory
