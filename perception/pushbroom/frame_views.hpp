#pragma once

#include <opencv2/core/mat.hpp>

#include "perception/assertion.hpp"
#include "perception/gray_view.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// A view of one image of a frame. Asserts that it is CV_8UC1 and of the rig's size.
inline GrayView view_of(const cv::Mat& image, const StereoRig& rig) {
  assert_always(image.type() == CV_8UC1, "stereo images must be 8-bit gray");
  assert_always(image.cols == rig.width_px && image.rows == rig.height_px,
                "stereo images must have the rig's size");
  return {image.data, static_cast<std::ptrdiff_t>(image.step[0]), image.cols, image.rows};
}

}  // namespace understory
