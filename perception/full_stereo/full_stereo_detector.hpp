#pragma once

#include <vector>

#include "perception/full_stereo/full_stereo.hpp"
#include "perception/obstacle_detector.hpp"
#include "perception/perception_config.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// The depths that the pushbroom detector means on this rig: one pixel of disparity either way of the whole
/// disparity nearest to its detection depth.
FullStereoCrop one_pixel_crop(const StereoRig& rig);

/// Full stereo in the detector's place. A hit is a cell of the left image with enough pixels at the wanted
/// depths, at the median of those; its score and edge sum are 0, for full stereo tells neither. Its depth
/// interval is that of half a pixel of disparity either way, beyond which another whole disparity would have
/// matched better.
class FullStereoDetector : public ObstacleDetector {
 public:
  /// FullStereo's preconditions.
  FullStereoDetector(const StereoRig& rig, const StereoBmConfig& config, const FullStereoCrop& crop)
      : rig_(rig), crop_(crop), stereo_(rig, config) {}
  FullStereoDetector(const StereoRig& rig, const StereoSgbmConfig& config, const FullStereoCrop& crop)
      : rig_(rig), crop_(crop), stereo_(rig, config) {}
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;
  /// That of the last frame, as FullStereo::depth_m; empty before the first.
  const cv::Mat& depth_m() const { return depth_m_; }

 private:
  void add_cell(const cv::Mat& depth_m, int column_px, int row_px);

  StereoRig rig_;
  FullStereoCrop crop_;
  FullStereo stereo_;
  cv::Mat depth_m_;
  std::vector<float> cell_m_;
  std::vector<StereoHit> hits_;
};

}  // namespace understory
