#pragma once

#include "perception/obstacle_detector.hpp"

namespace understory {

/// A detector without hits: the blind aircraft. It measures how easy a course is.
class NoDetector : public ObstacleDetector {
 public:
  const std::vector<StereoHit>& detect(const StereoFrame&) override { return none_; }

 private:
  std::vector<StereoHit> none_;
};

}  // namespace understory
