#pragma once

#include <Eigen/Core>

#include "estimation/error_state.hpp"

namespace understory {

/// The aircraft's velocity through the air, body axes, by the estimate: over ground less wind and gust (both
/// level). What pitot, winglets and wing feel.
struct AirVelocity {
  Eigen::Vector3d body_mps = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, error_states> jacobian = Eigen::Matrix<double, 3, error_states>::Zero();
};

AirVelocity air_velocity(const State& state);

}  // namespace understory
