#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "perception/stereo_hit.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// What one picture of the overlay shows.
struct OverlayMoment {
  cv::Mat left;                 ///< CV_8UC1, the rig's size
  std::vector<StereoHit> hits;  ///< of this very frame
  std::vector<ObstaclePoint> remembered;
  Eigen::Isometry3d T_world_camera;  ///< by the estimate, at the image's moment
  double airspeed_mps = 0;
  double altitude_m = 0;
};

/// The paper's overlay (Barry & Tedrake 2015), `scale` times as large: blue boxes for this frame's
/// detections, red dots for remembered points reprojected by the estimate, airspeed in mph at the left,
/// altitude in feet at the right. BGR 8-bit.
cv::Mat draw_overlay(const OverlayMoment& moment, const StereoRig& rig, int scale);

/// Two pictures of equal height side by side.
cv::Mat beside(const cv::Mat& left, const cv::Mat& right);

}  // namespace understory
