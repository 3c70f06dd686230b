#pragma once

#include <memory>
#include <utility>

#include "perception/obstacle_detector.hpp"
#include "perception/rectify.hpp"

namespace understory {

/// Gives raw pairs, rectified to the nearest pixel, to a detector that knows rectified ones only.
class RectifyingDetector : public ObstacleDetector {
 public:
  RectifyingDetector(const StereoCalibration& calibration, std::unique_ptr<ObstacleDetector> detector)
      : rectifier_(calibration, Interpolation::nearest), detector_(std::move(detector)) {}
  const std::vector<StereoHit>& detect(const StereoFrame& raw) override {
    return detector_->detect(rectifier_.rectify(raw));
  }

 private:
  Rectifier rectifier_;
  std::unique_ptr<ObstacleDetector> detector_;
};

}  // namespace understory
