#include "perception/io/stereo_rectification.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>

namespace understory {

bool rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left,
                  const cv::Vec3d& t_right_m) {
  CameraCalibration& left = calibration.left;
  CameraCalibration& right = calibration.right;
  const cv::Size size(calibration.width_px, calibration.height_px);
  cv::Mat disparity_to_depth;
  try {
    cv::stereoRectify(left.camera_matrix, left.distortion, right.camera_matrix, right.distortion, size,
                      R_right_left, t_right_m, left.rectification, right.rectification, left.projection,
                      right.projection, disparity_to_depth, cv::CALIB_ZERO_DISPARITY, 0, size);
  } catch (const cv::Exception&) {
    return false;  // the caller knows the file's name
  }
  double sum = 0;  // finite only if every term is
  for (const CameraCalibration* camera : {&left, &right}) {
    for (const double value : camera->rectification.val) sum += value;
    for (const double value : camera->projection.val) sum += value;
  }
  return std::isfinite(sum);
}

}  // namespace understory
