#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "perception/io/pose_file.hpp"

namespace understory {

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

}  // namespace understory
