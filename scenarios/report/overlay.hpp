#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
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
  /// By the estimate, at the image's moment.
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::optional<double> airspeed_mps;  ///< written where known
  std::optional<double> altitude_m;    ///< written where known
  std::string caption;                 ///< along the lower edge
};

/// The paper's overlay (Barry & Tedrake 2015), `scale` times as large: blue boxes for this frame's
/// detections, red dots for remembered points reprojected by the estimate, airspeed in mph at the left,
/// altitude in feet at the right. BGR 8-bit.
cv::Mat draw_overlay(const OverlayMoment& moment, const StereoRig& rig, int scale);

}  // namespace understory
