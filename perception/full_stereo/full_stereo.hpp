#pragma once

#include <opencv2/calib3d.hpp>

#include "perception/perception_config.hpp"
#include "perception/stereo_frame.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// The depth of every pixel that OpenCV matches: full stereo, which the pushbroom detector does without
/// (docs/decisions/012). Neither depends on the number of OpenCV's threads.
class FullStereo {
 public:
  /// Precondition (asserted): window_px is odd, disparities a multiple of 16, smoothness_2 above
  /// smoothness_1, and the rig's infinity leaves the images a common part wider than the window.
  FullStereo(const StereoRig& rig, const StereoBmConfig& config);
  FullStereo(const StereoRig& rig, const StereoSgbmConfig& config);

  /// Depth in the left image, CV_32FC1, metres along the optical axis, 0 where unmatched. `frame` is
  /// rectified and has the rig's size (asserted). Holds until the next call.
  const cv::Mat& depth_m(const StereoFrame& frame);

 private:
  FullStereo(const StereoRig& rig, int window_px, int min_disparity_px, int disparities);

  StereoRig rig_;
  int min_disparity_px_;
  int pad_px_;        // on the left, which OpenCV leaves unmatched
  int left_from_px_;  // first column of either image that a point at infinity shows in both
  int right_from_px_;
  int common_width_px_;
  double remainder_px_;  // of infinity, beyond whole columns
  cv::Ptr<cv::StereoMatcher> matcher_;
  cv::Mat left_, right_, disparity_;  // padded; disparity CV_16S, sixteenths of a pixel
  cv::Mat depth_m_;
};

}  // namespace understory
