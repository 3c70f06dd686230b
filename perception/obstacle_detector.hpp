#pragma once

#include <vector>

#include "perception/stereo_frame.hpp"
#include "perception/stereo_hit.hpp"

namespace understory {

/// Turns a stereo pair into hits. Implementations use no clock and may keep buffers and memory of earlier
/// frames.
class ObstacleDetector {
 public:
  virtual ~ObstacleDetector() = default;
  /// `frame` must have the rig's size and be CV_8UC1; a breach is a programming error and asserts.
  /// Hits come in a fixed order (from top to bottom), so that equal frames give equal outputs. They hold
  /// until the next call.
  virtual const std::vector<StereoHit>& detect(const StereoFrame& frame) = 0;
};

}  // namespace understory
