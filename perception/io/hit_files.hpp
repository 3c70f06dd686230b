#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "perception/stereo_hit.hpp"

namespace understory {

/// One frame's hits, and which frame that was.
struct FrameHits {
  std::int64_t frame = 0;  ///< counted from 0
  std::int64_t t_ns = 0;   ///< 0 throughout if the images have no times
  std::vector<StereoHit> hits;
};

/// One line per hit under the header
/// frame,t_ns,x_m,y_m,z_m,row_px,column_px,disparity_px,score,edge_sum,near_m,far_m
/// x, y, z: centre of the block in the left camera's rectified frame (OpenCV axes); row and column: the
/// block's upper left pixel in the rectified left image; disparity u_left - u_right; score S, edge sum and
/// depth interval as in StereoHit.
std::string hits_to_csv(const std::vector<FrameHits>& frames);

/// The same hits as an ASCII PLY cloud: x y z (camera frame, m), time (s), score, edge sum, depth interval
/// (near and far, m), frame.
std::string hits_to_ply(const std::vector<FrameHits>& frames);

/// Remembered points as an ASCII PLY cloud: x y z (the world they were remembered in, m), time (s), score,
/// and the odometer at their sighting (m).
std::string points_to_ply(const std::vector<ObstaclePoint>& points);

}  // namespace understory
