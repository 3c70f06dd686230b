#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "perception/stereo_calibration.hpp"
#include "sim/cameras/camera_config.hpp"
#include "sim/render/eye.hpp"

namespace understory {

/// The optics of the two cameras: which pinhole view is rendered for each, and how that view becomes the
/// camera's image. These are the true optics; a misaligned or bent rig differs from the stack's in the right
/// camera.
class StereoOptics {
 public:
  /// Without `raw` the images are the rectified pair that `rig` describes, and the views are the images. With
  /// `raw` they are those of the raw cameras before rectification, distorted and turned; `rig` is then
  /// rectified_rig(*raw). Throws std::runtime_error if no raw pixel has a ray.
  StereoOptics(const StereoRig& rig, const CameraConfig& config,
               const std::optional<StereoCalibration>& raw = std::nullopt);

  /// The views to render, left first, of equal size. The body may have moved between the two.
  std::array<Eye, 2> eyes(const Eigen::Isometry3d& T_world_body_left,
                          const Eigen::Isometry3d& T_world_body_right) const;
  /// The camera's image of a rendered view, CV_8UC1; 0 at raw pixels without a ray. eye: 0 left, 1 right.
  cv::Mat image(int eye, const cv::Mat& view) const;
  /// cos^power of the angle between each pixel's ray and its camera's own axis, CV_32FC1.
  cv::Mat falloff(int eye, double power) const;

 private:
  /// A raw camera's pixels as rays, and the pinhole view along its axis that contains them.
  struct RawCamera {
    Eigen::Matrix3d R_rectified_raw;
    cv::Mat rays;  ///< CV_64FC2: x/z, y/z of each raw pixel; NaN where there is none
    double center_x_px = 0, center_y_px = 0;  ///< of the view
    cv::Mat places = {}, fractions = {};      ///< of the view for each raw pixel: cv::convertMaps' form
  };
  void make_views();

  StereoRig rig_;
  Eigen::Isometry3d T_believed_true_right_ = Eigen::Isometry3d::Identity();
  double vertical_misalignment_px_;
  std::optional<std::array<RawCamera, 2>> raw_;
  double view_focal_px_ = 0;
  cv::Size view_size_;
};

}  // namespace understory
