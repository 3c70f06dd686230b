#pragma once

#include <opencv2/calib3d.hpp>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// OpenCV's StereoBM with the settings of the paper's evaluation (Barry & Tedrake 2015; public evaluation
/// code).
struct BlockMatchingConfig {
  int window_px = 5;  ///< odd, 5 .. 51
  int min_disparity_px = 2;
  int disparities = 112;  ///< multiple of 16; with the line above 2 .. 113 px
  int texture_threshold = 427;
  int uniqueness_percent = 18;
  int prefilter_size_px = 105;  ///< odd, 5 .. 255; without effect on OpenCV's default x-Sobel prefilter
  int prefilter_cap = 61;       ///< 1 .. 63
  int speckle_window_px = 59;
  int speckle_range = 30;
  double crop_m = 0.5;            ///< depths farther than this from the detection depth are dropped
  int cell_px = 5;                ///< one hit for each cell of this size, the pushbroom's block
  int least_pixels_per_cell = 5;  ///< matched pixels inside the crop that make a hit (our choice)
};

template <typename Visitor>
void visit_fields(Visitor& visit, BlockMatchingConfig& config) {
  visit("window_px", config.window_px, 5, 51);
  visit("min_disparity_px", config.min_disparity_px, -1000, 1000);
  visit("disparities", config.disparities, 16, 1024);
  visit("texture_threshold", config.texture_threshold, 0, 100000);
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100);
  visit("prefilter_size_px", config.prefilter_size_px, 5, 255);
  visit("prefilter_cap", config.prefilter_cap, 1, 63);
  visit("speckle_window_px", config.speckle_window_px, 0, 10000);
  visit("speckle_range", config.speckle_range, 0, 1000);
  visit("crop_m", config.crop_m, 0.0, 1000.0);
  visit("cell_px", config.cell_px, 1, 100);
  visit("least_pixels_per_cell", config.least_pixels_per_cell, 1, 10000);
}

/// StereoBM in the detector's place: dense matching, then only what lies near the detection depth, as in the
/// paper's first evaluation. A hit is a cell with enough such pixels, at the depth of their median disparity;
/// its score and edge sum are 0, for StereoBM tells neither.
class BlockMatching : public ObstacleDetector {
 public:
  BlockMatching(const StereoRig& rig, const BlockMatchingConfig& config);
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

 private:
  void add_cell(int column_px, int row_px);

  StereoRig rig_;
  BlockMatchingConfig config_;
  double least_disparity_px_, greatest_disparity_px_;  // of the crop
  cv::Ptr<cv::StereoBM> matcher_;
  cv::Mat disparity_;  // CV_16S, sixteenths of a pixel
  std::vector<std::int16_t> cell_;
  std::vector<StereoHit> hits_;
};

}  // namespace understory
