#pragma once

#include <Eigen/Core>

#include "estimation/error_state.hpp"

namespace understory {

/// The estimated velocity through the air, body axes: velocity over ground minus wind and gust (both level).
/// Pitot, winglets and wing feel it.
struct AirVelocity {
  Eigen::Vector3d body_mps = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, error_states> jacobian = Eigen::Matrix<double, 3, error_states>::Zero();
};

AirVelocity air_velocity(const State& state);

}  // namespace understory
