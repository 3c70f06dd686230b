#include "perception/stereo_calibration.hpp"

#include <cmath>
#include <stdexcept>

namespace understory {

StereoRig rectified_rig(const StereoCalibration& calibration, double detection_depth_m) {
  const cv::Matx34d& left = calibration.left.projection;
  const cv::Matx34d& right = calibration.right.projection;
  const auto expect = [&](bool holds, const char* expected) {
    if (!holds) throw std::runtime_error(calibration.name + ": " + expected);
  };
  expect(left(0, 0) > 0, "P1: the focal length must be positive");
  expect(std::abs(left(0, 0) - left(1, 1)) < 1e-6 * left(0, 0) &&
             std::abs(right(0, 0) - left(0, 0)) < 1e-6 * left(0, 0) &&
             std::abs(right(1, 1) - left(0, 0)) < 1e-6 * left(0, 0),
         "P1, P2: the focal length must be the same in both, along both axes");
  expect(std::abs(left(1, 2) - right(1, 2)) < 1e-6 * left(0, 0),
         "P1, P2: the rows of both images must be aligned");
  expect(right(0, 3) < 0, "P2: the right camera must lie to the right of the left one: P2(0,3) negative");

  StereoRig rig;
  rig.name = calibration.name;
  rig.width_px = calibration.width_px;
  rig.height_px = calibration.height_px;
  rig.focal_px = left(0, 0);
  rig.baseline_m = -right(0, 3) / right(0, 0);
  rig.center_left_x_px = left(0, 2);
  rig.center_right_x_px = right(0, 2);
  rig.center_y_px = left(1, 2);
  rig.detection_depth_m = detection_depth_m;
  Eigen::Matrix3d rectified_of_raw;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rectified_of_raw(i, j) = calibration.left.rectification(i, j);
  rig.T_body_camera = calibration.T_body_left;
  rig.T_body_camera.linear() = calibration.T_body_left.linear() * rectified_of_raw.transpose();
  return rig;
}

CameraCalibration rectified_camera(const StereoRig& rig, double center_x_px, double right_of_left_m) {
  const double f = rig.focal_px;
  CameraCalibration camera;
  camera.camera_matrix = cv::Matx33d(f, 0, center_x_px, 0, f, rig.center_y_px, 0, 0, 1);
  camera.distortion = {0, 0, 0, 0};
  camera.projection =
      cv::Matx34d(f, 0, center_x_px, 0 - f * right_of_left_m, 0, f, rig.center_y_px, 0, 0, 0, 1, 0);
  return camera;
}

}  // namespace understory
