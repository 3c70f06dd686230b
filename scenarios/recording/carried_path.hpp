#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "sim/aircraft/truth.hpp"

namespace understory {

/// Poses along which cameras are carried: TUM's or EuRoC's form (perception/io/pose_file.hpp), or the true
/// poses of a run's trajectory.csv. Throws ScenarioError in one line where there are fewer than two, times do
/// not increase, or two poses need more than 100 m/s or a quarter turn.
std::vector<TimedPose> read_path(const std::filesystem::path& file);

/// Those at least 0.05 s apart, with both ends, because files round positions: a tenth of a millimetre at 200
/// Hz is 8 m/s^2.
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

/// What is true of it at t_ns: pose, and from it by central differences (over 0.2 ms) velocity, rates and
/// specific force. The pose is asked for a little before and after that moment, too.
Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2);

}  // namespace understory
