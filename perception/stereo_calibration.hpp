#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/core/matx.hpp>
#include <optional>
#include <string>
#include <vector>

#include "perception/stereo_rig.hpp"

namespace understory {

/// How a lens bends rays: by a polynomial of the tangent of their angle to the axis, as OpenCV's calib3d has
/// it, or by one of the angle itself (Kannala & Brandt 2006, TPAMI 28(8)), as cv::fisheye and, under this
/// name, Kalibr and ROS have it.
enum class LensModel { radial_tangential, equidistant };

/// One raw camera and its place in the rectified pair, in OpenCV's terms (calib3d's documentation):
/// a rectified direction is turned back by `rectification`, distorted, and projected by `camera_matrix`.
struct CameraCalibration {
  cv::Matx33d camera_matrix = cv::Matx33d::eye();  ///< of the raw image: fx, fy, cx, cy in pixels, no skew
  LensModel lens = LensModel::radial_tangential;
  /// k1 k2 p1 p2 [k3 [k4 k5 k6]]: 4, 5 or 8 numbers, or none. Of an equidistant lens k1 k2 k3 k4.
  std::vector<double> distortion;
  cv::Matx33d rectification = cv::Matx33d::eye();  ///< R1 or R2: raw camera axes into rectified ones
  cv::Matx34d projection =
      cv::Matx34d::zeros();  ///< P1 or P2: rectified pixels; P2(0,3) = -focal * baseline, m

  /// Whether the lens has any distortion: an equidistant one always has.
  bool bends() const {
    return lens == LensModel::equidistant ||
           std::ranges::any_of(distortion, [](double coefficient) { return coefficient != 0; });
  }
};

/// A stereo pair of raw cameras. Raw and rectified images have the same size.
struct StereoCalibration {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  CameraCalibration left;
  CameraCalibration right;
  /// Where the raw left camera sits: its coordinates (OpenCV axes) into body coordinates.
  Eigen::Isometry3d T_body_left = Eigen::Isometry3d::Identity();
};

/// A rig, and the raw cameras behind it where images come raw (absent: they come rectified).
struct CalibratedRig {
  StereoRig rig;
  std::optional<StereoCalibration> calibration;
};

/// The rectified pair that `calibration` describes, with `detection_depth_m`: focal length, baseline and
/// principal points from the projections, the camera's pose turned by the left rectification. Throws
/// std::runtime_error where the projections are no rectified pair (unequal focal lengths or rows, no positive
/// baseline).
StereoRig rectified_rig(const StereoCalibration& calibration, double detection_depth_m);

/// A camera of `rig` whose images come rectified, so that rectifying them changes nothing. `right_of_left_m`:
/// 0, or the baseline for the right one.
CameraCalibration rectified_camera(const StereoRig& rig, double center_x_px, double right_of_left_m);

}  // namespace understory
