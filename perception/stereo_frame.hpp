#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace understory {

/// One rectified stereo pair: both images 8-bit gray (CV_8UC1), of the rig's size, exposed at the same
/// moment.
struct StereoFrame {
  std::int64_t t_ns = 0;  ///< moment of exposure, simulation or vehicle clock
  cv::Mat left;
  cv::Mat right;
};

}  // namespace understory
