#pragma once

#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/flight/oracles/truth_history.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// Perfect detection at the pushbroom's depth: a hit for every 5x5 block of the left image (rows 0..205, as
/// the original detector) whose centre ray first meets a bar or wall within one pixel of disparity of the
/// detection depth. The depth is analytic (ray against round bar or box); images are not used. Hits carry the
/// true point.
class TrueDepth : public ObstacleDetector {
 public:
  /// Keeps a reference to the history, which must cover the time of every frame.
  TrueDepth(const StereoRig& rig, std::vector<Obstacle> obstacles, const TruthHistory& history);
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

  /// The depth interval of a hit, m: one pixel either side of the nearest whole disparity.
  double minimum_depth_m() const { return minimum_depth_m_; }
  double maximum_depth_m() const { return maximum_depth_m_; }

 private:
  StereoRig rig_;
  std::vector<Obstacle> obstacles_;
  const TruthHistory& history_;
  double minimum_depth_m_ = 0;
  double maximum_depth_m_ = 0;
  std::vector<StereoHit> hits_;
};

/// Where a ray first meets a wall, world frame, as for bars below.
double ray_meets_wall(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                      const Obstacle& wall);

/// Where a ray first meets a bar's side: the multiple of `direction` from `origin`; +infinity where it does
/// not. All in one frame. From inside the bar the answer is +infinity.
double ray_meets_bar(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                     const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m);

}  // namespace understory
