#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "perception/stereo_hit.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// What is true of a frame's rectified left image.
struct TrueImages {
  cv::Mat depth_mm;  ///< CV_16UC1, along the optical axis; 0 where nothing is known or all is far
  cv::Mat objects;   ///< CV_16UC1, numbers of objects.csv; empty where nobody says whose surface it is
  /// depth_mm where the right eye sees the same place, 0 where something nearer covers it there: no pair of
  /// eyes can match what one of them does not see.
  cv::Mat shared_depth_mm;
};

/// What shared_depth_mm is, from depth_mm alone: every pixel is put where the right image has it, and the
/// nearest stays. What lies beyond the left image's edge and covers something is not known of.
cv::Mat shared_depth(const cv::Mat& depth_mm, const StereoRig& rig);

/// A detection says of 5x5 pixels "something stands at this depth". A fifth of them at that depth makes it
/// true: blocks at the edge of a trunk match by the part of it that they hold. The same fifth makes a block
/// one that should have been found.
inline constexpr int truth_block_px = 5;
inline constexpr int minimum_true_pixels = 5;

/// What a block holds between two depths.
struct BlockContent {
  int pixels = 0;           ///< of 25
  int object = 0;           ///< that most of them belong to; 0 where nobody says
  double mean_depth_m = 0;  ///< of these pixels
  bool holds() const { return pixels >= minimum_true_pixels; }
};

/// Of the block whose top left pixel is (column_px, row_px), inside the image. `obstacles_only`: pixels of
/// nothing and of the ground (objects 0 and 1) do not count.
BlockContent content_between(const TrueImages& truth, int column_px, int row_px, DepthInterval depths,
                             bool obstacles_only);

/// The same of obstacles' pixels that both eyes see.
BlockContent shared_between(const TrueImages& truth, int column_px, int row_px, DepthInterval depths);

}  // namespace understory
