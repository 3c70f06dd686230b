#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>

#include "sim/aircraft/truth.hpp"

namespace understory {

/// Where a body that is carried is, after so many seconds. Smooth: twice differentiable at least.
using CarriedPose = std::function<Eigen::Isometry3d(double t_s)>;

/// What is true of it at t_ns: pose, and from it by central differences (over 0.2 ms) velocity, rates and
/// specific force. The pose is asked for a little before and after that moment, too.
Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2);

}  // namespace understory
