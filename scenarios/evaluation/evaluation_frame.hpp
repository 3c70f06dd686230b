#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "perception/stereo_frame.hpp"
#include "scenarios/evaluation/block_truth.hpp"

namespace understory {

/// A thing of objects.csv: a bar between two points (world frame, m); the ground has no geometry.
struct RecordedObject {
  int number = 0;  ///< its pixels' value
  std::string name;
  std::string kind;  ///< ground, trunk, post, crossbar, rail, wall
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();
  double radius_m = 0;
  bool is_obstacle() const { return number > 1; }
};

/// A recorded moment and all that is known of it.
struct EvaluationFrame {
  StereoFrame pair;  ///< rectified
  TrueImages truth;  ///< empty where the recording has no depth
  /// Of the left camera, true; nothing where no pose covers the moment.
  std::optional<Eigen::Isometry3d> T_world_camera;
  /// Where the flight itself believed to be, in its odometry frame; the true pose where it did not say.
  std::optional<Eigen::Isometry3d> T_odometry_camera;
  double speed_mps = 0;  ///< true; 0 where no pose is known
  double bank_rad = 0;   ///< the camera's rows against the horizon, 0 .. pi/2
  double mean_gray = 0;  ///< of the left image
};

}  // namespace understory
