#pragma once

#include <Eigen/Core>

#include "perception/stereo_rig.hpp"

namespace understory {

/// One detection in one stereo pair: a block of the left image that matches at the detection disparity.
struct StereoHit {
  Eigen::Vector3d position_camera = Eigen::Vector3d::Zero();  ///< centre of the block, left camera frame, m
  int column_px = 0;                                          ///< left edge of the block in the left image
  int row_px = 0;                                             ///< top edge of the block
  double disparity_px = 0;                                    ///< u_left - u_right
  double score = 0;          ///< the paper's S = SAD / (sum of both blocks' edges); smaller is better
  double edge_sum = 0;       ///< sum of both blocks' Laplacian edge sums
  DepthInterval depth = {};  ///< one pixel of disparity either way; both 0 where a detector does not say
};

}  // namespace understory
