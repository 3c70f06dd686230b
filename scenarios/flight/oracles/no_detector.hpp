#pragma once

#include "perception/obstacle_detector.hpp"

namespace understory {

/// The blind aircraft: what the course itself lets pass.
class NoDetector : public ObstacleDetector {
 public:
  const std::vector<StereoHit>& detect(const StereoFrame&) override { return none_; }

 private:
  std::vector<StereoHit> none_;
};

}  // namespace understory
