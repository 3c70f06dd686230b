#pragma once

#include <opencv2/calib3d.hpp>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/perception_config.hpp"
#include "perception/stereo_frame.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// The depths that the pushbroom detector covers on this rig: one pixel of disparity either way of the whole
/// disparity nearest to its detection depth.
FullStereoCrop one_pixel_crop(const StereoRig& rig);

/// Hits of a dense depth image: CV_32FC1, metres along the optical axis of the left camera, 0 where unknown.
/// A hit is a cell of the left image with enough pixels at the wanted depths; its depth is their median, its
/// score and edge sum are 0. Its depth interval is that of half a pixel of disparity either way.
void hits_of_depth(const cv::Mat& depth_m, const StereoRig& rig, const FullStereoCrop& crop,
                   std::vector<StereoHit>& hits);

/// Full stereo matching as an alternative to the pushbroom detector (docs/decisions/012): OpenCV matches
/// every pixel; hits are those of hits_of_depth(). Does not depend on the number of OpenCV's threads.
class FullStereoDetector : public ObstacleDetector {
 public:
  /// Precondition (asserted): window_px is odd, disparities a multiple of 16, smoothness_2 above
  /// smoothness_1, and at infinity the images show a common part wider than the window.
  FullStereoDetector(const StereoRig& rig, const StereoBmConfig& config, const FullStereoCrop& crop);
  FullStereoDetector(const StereoRig& rig, const StereoSgbmConfig& config, const FullStereoCrop& crop);

  /// `frame` is rectified and has the rig's size (asserted).
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;
  /// Depth in the left image of the last frame, CV_32FC1, metres along the optical axis, 0 where unmatched.
  /// Empty before the first frame.
  const cv::Mat& depth_m() const { return depth_m_; }

 private:
  FullStereoDetector(const StereoRig& rig, const FullStereoCrop& crop, int window_px, int min_disparity_px,
                     int disparities);
  void match(const StereoFrame& frame);

  StereoRig rig_;
  FullStereoCrop crop_;
  int min_disparity_px_;
  int pad_px_;        // on the left, which OpenCV leaves unmatched
  int left_from_px_;  // first column of each image where a point at infinity is in both
  int right_from_px_;
  int common_width_px_;
  double remainder_px_;  // of infinity, beyond whole columns
  cv::Ptr<cv::StereoMatcher> matcher_;
  cv::Mat left_, right_, disparity_;  // padded; disparity CV_16S, sixteenths of a pixel
  cv::Mat depth_m_;
  std::vector<StereoHit> hits_;
};

}  // namespace understory
