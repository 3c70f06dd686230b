#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace understory {

/// One moment of a plan, as the reduced flight model predicts it.
struct PlanPoint {
  double t_s = 0;  ///< since the plan's start
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  double speed_mps = 0;
  double heading_rad = 0;      ///< of the velocity through the air, from world x towards world y
  double climb_angle_rad = 0;  ///< of the same, above the horizon
  double bank_rad =
      0;  ///< right wing down positive, so that a positive bank turns to the right (heading falls)
  double angle_of_attack_rad = 0;
  double bank_command_rad = 0;  ///< the control in force
  double climb_command_mps = 0;
};

/// How a plan came about.
enum class PlanOrigin {
  straight,  ///< nothing in the way: towards the goal, holding altitude
  solved,    ///< OMPL found it in this replan
  kept,      ///< an earlier plan, still valid and good
  fallback   ///< nothing free of collision found: the primitive with the maximum clearance
};

struct Plan {
  std::int64_t t_ns = 0;  ///< the moment its first point stands for
  PlanOrigin origin = PlanOrigin::straight;
  std::vector<PlanPoint> points;  ///< evenly spaced in time; empty before the first replan
};

}  // namespace understory
