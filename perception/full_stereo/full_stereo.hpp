#pragma once

#include <array>
#include <opencv2/calib3d.hpp>
#include <string_view>
#include <utility>

#include "perception/stereo_frame.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// OpenCV's StereoBM with the settings of the paper's evaluation (Barry & Tedrake 2015; public evaluation
/// code). Disparities count from the rig's infinity, so 2 .. 113 px are parallax.
struct StereoBmConfig {
  int window_px = 5;  ///< odd, 5 .. 51
  int min_disparity_px = 2;
  int disparities = 112;  ///< multiple of 16
  int texture_threshold = 427;
  int uniqueness_percent = 18;
  int prefilter_size_px = 105;  ///< odd, 5 .. 255; without effect on OpenCV's default x-Sobel prefilter
  int prefilter_cap = 61;       ///< 1 .. 63
  int speckle_window_px = 59;   ///< smaller patches are dropped
  int speckle_range = 30;       ///< sixteenths of a pixel between neighbours of a patch
};

/// How many paths StereoSGBM gathers costs along. Three is OpenCV's fast way, five its default.
enum class SgbmPaths { three, five, eight };
inline constexpr std::array<std::pair<std::string_view, SgbmPaths>, 3> sgbm_paths_names{
    {{"three", SgbmPaths::three}, {"five", SgbmPaths::five}, {"eight", SgbmPaths::eight}}};

/// OpenCV's StereoSGBM (Hirschmueller 2008). The paper flew none: the search is StereoBM's above, the rest
/// the values that OpenCV's documentation of cv::StereoSGBM and its sample stereo_match.cpp suggest.
struct StereoSgbmConfig {
  int window_px = 5;  ///< odd, 1 .. 11 (documentation: 3 .. 11)
  int min_disparity_px = 2;
  int disparities = 112;        ///< multiple of 16
  int smoothness_1 = 8;         ///< P1 in windows' areas: a step of one pixel costs so much (sample)
  int smoothness_2 = 32;        ///< P2 likewise: of more pixels; more than smoothness_1
  int uniqueness_percent = 10;  ///< documentation: 5 .. 15
  int prefilter_cap = 63;       ///< sample
  int left_right_px = 1;        ///< matched back from the right, at most so far off (sample); -1: not asked
  int speckle_window_px = 100;  ///< documentation: 50 .. 200
  int speckle_range_px = 2;     ///< documentation: 1 or 2
  SgbmPaths paths = SgbmPaths::five;
};

template <typename Visitor>
void visit_fields(Visitor& visit, StereoBmConfig& config) {
  visit("window_px", config.window_px, 5, 51);
  visit("min_disparity_px", config.min_disparity_px, 1, 1000);
  visit("disparities", config.disparities, 16, 1024);
  visit("texture_threshold", config.texture_threshold, 0, 100000);
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100);
  visit("prefilter_size_px", config.prefilter_size_px, 5, 255);
  visit("prefilter_cap", config.prefilter_cap, 1, 63);
  visit("speckle_window_px", config.speckle_window_px, 0, 10000);
  visit("speckle_range", config.speckle_range, 0, 1000);
}

template <typename Visitor>
void visit_fields(Visitor& visit, StereoSgbmConfig& config) {
  visit("window_px", config.window_px, 1, 11);
  visit("min_disparity_px", config.min_disparity_px, 1, 1000);
  visit("disparities", config.disparities, 16, 1024);
  visit("smoothness_1", config.smoothness_1, 0, 1000);
  visit("smoothness_2", config.smoothness_2, 1, 1000);
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100);
  visit("prefilter_cap", config.prefilter_cap, 1, 127);
  visit("left_right_px", config.left_right_px, -1, 100);
  visit("speckle_window_px", config.speckle_window_px, 0, 10000);
  visit("speckle_range_px", config.speckle_range_px, 0, 100);
  visit("paths", config.paths, sgbm_paths_names);
}

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
