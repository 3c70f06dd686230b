#pragma once

#include <opencv2/core/matx.hpp>

#include "perception/stereo_calibration.hpp"

namespace understory {

/// Fills both cameras' `rectification` and `projection` with cv::stereoRectify's (CALIB_ZERO_DISPARITY, alpha
/// 0: principal points alike, every rectified pixel seen by the raw image). Camera matrices, distortion and
/// size must be there. A point's coordinates in the left camera become those in the right one by
/// R_right_left * x + t_right. False where no rectified pair comes out of it.
bool rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left,
                  const cv::Vec3d& t_right_m);

}  // namespace understory
