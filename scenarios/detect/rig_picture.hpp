#pragma once

#include <opencv2/core/mat.hpp>

#include "scenarios/detect/rig_figures.hpp"

namespace understory {

/// The rig from above, in metres: both cameras, what they see, the surface the detector looks at and its
/// one-pixel band; beside it what is compared in the two images. CV_8UC3, 1280 x 860.
cv::Mat draw_rig(const StereoRig& rig, const RigFigures& figures);

}  // namespace understory
