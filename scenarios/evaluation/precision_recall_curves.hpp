#pragma once

#include <memory>
#include <vector>

#include "scenarios/evaluation/recording_evaluation.hpp"

namespace understory {

/// Every algorithm at several thresholds over the same frames: score limit or uniqueness of the pushbroom,
/// uniqueness of StereoBM and StereoSGBM.
class CurveSweeps {
 public:
  CurveSweeps(const StereoRig& rig, const DetectionGrid& grid, const EvaluationSettings& settings);
  void add(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected);
  const std::vector<PrecisionRecallCurve>& curves() const { return curves_; }

 private:
  void add_rule(const StereoRig& rig, const std::string& name, const PushbroomConfig& rule);
  template <typename Config>
  void add_full_stereo(const StereoRig& rig, const std::string& name, Config config,
                       const FullStereoCrop& crop, const std::vector<int>& uniqueness_percent);

  DetectionGrid grid_;
  std::vector<PrecisionRecallCurve> curves_;
  std::vector<std::vector<std::unique_ptr<ObstacleDetector>>> detectors_;  ///< a curve's, point by point
};

}  // namespace understory
