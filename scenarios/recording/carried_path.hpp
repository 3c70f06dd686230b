#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "sim/aircraft/truth.hpp"

namespace understory {

/// Poses to carry cameras along: TUM's or EuRoC's form (perception/io/pose_file.hpp), or a run folder's
/// trajectory.csv, of which the true pose counts. Throws ScenarioError in one line where there are fewer than
/// two, or where one cannot follow another: times that do not increase, more than 100 m/s, a quarter turn at
/// once.
std::vector<TimedPose> read_path(const std::filesystem::path& file);

/// Those at least 0.05 s apart, with both ends. Files round: at 200 Hz a tenth of a millimetre is 8 m/s^2 to
/// and fro.
std::vector<TimedPose> thinned(const std::vector<TimedPose>& poses);

/// A way through given poses that an IMU can be carried along: natural cubic splines (de Boor, A Practical
/// Guide to Splines, 1978, chapter IV) of the position and of the quaternion's components, brought back to
/// length 1. So accelerations are continuous, and a straight line at constant speed stays one. Time runs from
/// the first pose.
class SmoothPath {
 public:
  /// `poses`: at least two, their times strictly increasing, each attitude less than half a turn from the one
  /// before.
  explicit SmoothPath(const std::vector<TimedPose>& poses);
  /// Before the start and after the end the first and the last piece go on.
  Eigen::Isometry3d at(double t_s) const;
  double length_s() const { return times_s_.back(); }

 private:
  using Channels = Eigen::Matrix<double, 7, 1>;  ///< x y z, m; quaternion w x y z
  void solve_second_derivatives();

  std::vector<double> times_s_;
  std::vector<Channels> values_, second_derivatives_;
};

/// Where a body that is carried is, after so many seconds. Smooth: twice differentiable at least.
using CarriedPose = std::function<Eigen::Isometry3d(double t_s)>;

/// What is true of it at t_ns: pose, and from it by central differences (over 0.2 ms) velocity, rates and
/// specific force. The pose is asked for a little before and after that moment, too.
Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2);

}  // namespace understory
