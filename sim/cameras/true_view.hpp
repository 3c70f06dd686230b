#pragma once

#include <opencv2/core/mat.hpp>

namespace understory {

/// Depth and object at every pixel of a camera's view.
struct TrueView {
  cv::Mat depth_m;  ///< CV_32FC1: along the optical axis; the far plane's where there is nothing
  cv::Mat objects;  ///< CV_16UC1: the numbers of sim/scene/obstacle.hpp; nothing, too, where a far obstacle
                    ///< was culled
};

}  // namespace understory
