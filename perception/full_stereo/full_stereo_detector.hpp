#pragma once

#include <vector>

#include "perception/full_stereo/full_stereo.hpp"
#include "perception/obstacle_detector.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// What of a depth image becomes hits.
struct FullStereoCrop {
  double minimum_depth_m = 1.5;  ///< 0.1 .. 1000 (Barry & Tedrake 2015 ignore nearer points)
  /// 0.1 .. 1000. At 15 m a pixel of disparity is 3.5 m of the paper's rig and 1.7 m of the long one: what
  /// lies farther is seen too coarsely to be placed (our choice).
  double maximum_depth_m = 15;
  /// 0.1 .. 1000; hits farther below the optical axis are dropped: beneath the pushbroom's last row, at its
  /// depth, the ground begins (2.6 m below on the long rig, 2.8 m on the paper's), and farther out that row
  /// would see it.
  double maximum_below_m = 2.7;
  int cell_px = 5;                  ///< one hit for each cell of this size, the pushbroom's block
  int minimum_pixels_per_cell = 5;  ///< matched pixels inside the depths that make a hit (our choice)
  int last_row_px = 205;            ///< top edge of the lowest row of cells, the pushbroom's
};

template <typename Visitor>
void visit_fields(Visitor& visit, FullStereoCrop& crop) {
  visit("minimum_depth_m", crop.minimum_depth_m, 0.1, 1000.0);
  visit("maximum_depth_m", crop.maximum_depth_m, 0.1, 1000.0);
  visit("maximum_below_m", crop.maximum_below_m, 0.1, 1000.0);
  visit("cell_px", crop.cell_px, 1, 100);
  visit("minimum_pixels_per_cell", crop.minimum_pixels_per_cell, 1, 10000);
  visit("last_row_px", crop.last_row_px, 0, 4000);
}

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
