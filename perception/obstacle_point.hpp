#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace understory {

/// One remembered detection, fixed in the estimator's world frame (its odometry frame) when it was seen.
struct ObstaclePoint {
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< m
  std::int64_t t_ns = 0;                                     ///< moment of the image it comes from
  double score = 0;                                          ///< the hit's score S
  double distance_flown_m =
      0;              ///< the estimate's odometer at that moment; growth since then widens the point
  int sightings = 1;  ///< frames that saw it; all other fields are those of the newest
};

}  // namespace understory
