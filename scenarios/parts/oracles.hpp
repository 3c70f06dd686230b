#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "estimation/state_source.hpp"
#include "perception/obstacle_detector.hpp"
#include "perception/stereo_rig.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// The truth of the last 0.6 s, for the oracles. The flight adds to it at every physics step.
class TruthHistory {
 public:
  void observe(const Truth& truth);
  /// The newest truth not later than t_ns, or the oldest. Asserts that there is one.
  const Truth& at(std::int64_t t_ns) const;

 private:
  std::deque<Truth> moments_;
};

/// The truth in place of the filter: no error, no covariance. Keeps a reference to the history.
class TrueState : public StateSource {
 public:
  /// `distance_flown_m`: the odometer at its start.
  explicit TrueState(const TruthHistory& history, double distance_flown_m = 0) : history_(history) {
    state_.distance_flown_m = distance_flown_m;
  }
  void on(const Sample& sample) override;
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override;

 private:
  const TruthHistory& history_;
  State state_;
};

/// A truth as a State with no error.
State state_of(const Truth& truth);

/// A detector without hits: the blind aircraft. It measures how easy a course is.
class NoDetector : public ObstacleDetector {
 public:
  const std::vector<StereoHit>& detect(const StereoFrame&) override { return none_; }

 private:
  std::vector<StereoHit> none_;
};

/// For each depth one pixel of disparity either side of the whole disparity nearest to it.
std::vector<DepthInterval> intervals_around(const std::vector<double>& depths_m, const StereoRig& rig);

/// Perfect detection at one depth or several: a hit for every 5x5 block of the left image (rows 0..205, as
/// the original detector) whose centre ray first meets an obstacle within one of the
/// intervals. The depth is analytic (ray against the obstacle's shape); images are not used, and
/// leaves, which do not stop the aircraft, are not seen. Hits carry the true point.
class TrueDepth : public ObstacleDetector {
 public:
  /// Keeps a reference to the history, which must cover the time of every frame.
  /// `intervals`: of depths that have hits; none: one pixel of disparity either side of the whole disparity
  /// nearest to the rig's detection depth.
  TrueDepth(const StereoRig& rig, std::vector<Obstacle> obstacles, const TruthHistory& history,
            std::vector<DepthInterval> intervals = {});
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

  /// Which obstacle each of the newest hits lies on.
  const std::vector<std::size_t>& obstacles_of_hits() const { return obstacles_of_hits_; }
  /// The first depth interval of a hit, m.
  DepthInterval interval() const { return intervals_.front(); }
  /// Of blocks.
  int rows() const;
  int columns() const;
  /// A hit in the middle of that block.
  StereoHit hit_at(int row, int column, double depth_m) const;

 private:
  Eigen::Vector3d ray_of(int row, int column) const;

  StereoRig rig_;
  std::vector<Obstacle> obstacles_;
  const TruthHistory& history_;
  std::vector<DepthInterval> intervals_;
  std::vector<std::pair<double, std::size_t>> nearest_;  ///< by block: depth (m) and number of an obstacle
  std::vector<StereoHit> hits_;
  std::vector<std::size_t> obstacles_of_hits_;
};

/// Where a ray first meets an obstacle of any shape, as for round obstacles below.
double ray_meets(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                 const Obstacle& obstacle);

/// Where a ray first meets a wall, world frame, as for round obstacles below.
double ray_meets_wall(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                      const Obstacle& wall);

/// Where a ray first meets an obstacle's side: the multiple of `direction` from `origin`; +infinity where it
/// does not. All in one frame. From inside the obstacle the answer is +infinity.
double ray_meets_round_obstacle(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m);

}  // namespace understory
