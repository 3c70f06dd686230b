#pragma once

#include <memory>
#include <vector>

#include "scenarios/evaluation/recording_evaluation.hpp"

namespace understory {

/// Every algorithm at several thresholds over the same frames: score limit and uniqueness of the pushbroom,
/// uniqueness of StereoBM and StereoSGBM. The pushbroom takes every fourth frame, the others every 24th.
class CurveSweeps {
 public:
  CurveSweeps(const StereoRig& rig, const DetectionGrid& grid, const EvaluationSettings& settings);
  void add(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected);
  std::vector<PrecisionRecallCurve> curves() const;

 private:
  struct Sweep {
    std::string algorithm, threshold;
    std::int64_t every = 1;
    std::vector<std::unique_ptr<ObstacleDetector>> detectors;
    std::vector<CurvePoint> points;
  };
  void add_rule(const StereoRig& rig, const std::string& name, const PushbroomConfig& rule);

  DetectionGrid grid_;
  std::vector<Sweep> sweeps_;
  std::int64_t frames_ = 0;
};

}  // namespace understory
