#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace understory {

/// One stereo pair as the cameras give it: both images 8-bit gray (CV_8UC1), of the rig's size, exposed at
/// the same moment. A detector made for a rig without a calibration takes them as rectified; one made for raw
/// cameras (CalibratedRig::calibration) rectifies them itself.
struct StereoFrame {
  std::int64_t t_ns = 0;  ///< moment of exposure, simulation or vehicle clock
  cv::Mat left;
  cv::Mat right;
};

}  // namespace understory
