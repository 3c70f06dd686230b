#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// Poses along which cameras are carried: TUM's or EuRoC's form (perception/io/pose_file.hpp), or the true
/// poses of a run's trajectory.csv. Throws ScenarioError in one line where there are fewer than two, times do
/// not increase, or two poses need more than 100 m/s or a quarter turn.
std::vector<TimedPose> read_path(const std::filesystem::path& file);

/// The poses at least 0.05 s apart, with both ends, because files round positions: a tenth of a millimetre at
/// 200 Hz is 8 m/s^2.
std::vector<TimedPose> thinned(const std::vector<TimedPose>& poses);

/// A smooth path through given poses: natural cubic splines (de Boor, A Practical Guide to Splines, 1978,
/// chapter IV) of the position and of the quaternion's components, normalised. Accelerations are continuous,
/// and a straight line at constant speed remains one. Time runs from the first pose.
class SmoothPath {
 public:
  /// `poses`: at least two, their times strictly increasing, each attitude less than half a turn from the one
  /// before.
  explicit SmoothPath(const std::vector<TimedPose>& poses);
  /// Outside its time the first and the last piece continue.
  Eigen::Isometry3d at(double t_s) const;
  double length_s() const { return times_s_.back(); }

 private:
  using Channels = Eigen::Matrix<double, 7, 1>;  ///< x y z, m; quaternion w x y z
  void solve_second_derivatives();

  std::vector<double> times_s_;
  std::vector<Channels> values_, second_derivatives_;
};

/// The pose of a carried body after a time, s. At least twice differentiable.
using CarriedPose = std::function<Eigen::Isometry3d(double t_s)>;

/// The truth of a carried body at t_ns: pose, and from it by central differences (over 0.2 ms) velocity,
/// rates and specific force. pose_at is also called for times shortly before and after t_ns.
Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2);

/// The cameras carried past obstacles, as the paper's ground data were taken.
struct WalkConfig {
  double speed_mps = 1.4;  ///< a pedestrian's (Bohannon 1997: 1.27 to 1.46), 0.1 .. 5
  double height_m = 1.7;   ///< of the body's origin: shoulders or eyes, 0.3 .. 8
};

/// A straight level line along world x, and the sway about it.
struct WalkPath {
  WalkConfig config;
  double from_x_m = 0;
  double lane_y_m = 0;
  double pitch_rad = 0;  ///< about body y, so that the cameras look level
  double gravity_mps2 = 9.81;
  std::array<double, 4> phases_rad = {};  ///< of the sways
};

/// A path along the lane nearest to the middle that keeps shoulders clear of all obstacles, from 10 m before
/// the first of them. The sway's phases come from the scenario's seed. Throws ScenarioError where no lane
/// within the course is free.
WalkPath walk_path(const WalkConfig& config, const Scenario& scenario, const StereoRig& rig,
                   const std::vector<Obstacle>& obstacles);

/// The walking body at t_ns (from 0): pose, and from it by central differences velocity, rates and specific
/// force. Sway with every step (1.8 Hz at 1.4 m/s): 2 cm up and down, 0.6 deg of pitch. With every second
/// step: 2.5 cm from side to side, 1 deg of roll and yaw. Also a slow yaw of 2 deg.
Truth walk_truth(const WalkPath& path, std::int64_t t_ns);

}  // namespace understory
