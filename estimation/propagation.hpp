#pragma once

#include <Eigen/Core>

#include "estimation/error_state.hpp"
#include "estimation/state.hpp"

namespace understory {

/// What drives the estimate over one interval, held constant over it: corrected angular rate and specific
/// force.
struct InertialStep {
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_body_mps2 = Eigen::Vector3d::Zero();
  double dt_s = 0;
};

/// White noise of the inputs, as densities: over one interval each adds density^2 * dt to its integral's
/// variance.
struct ProcessNoise {
  double gyro_radps_rthz = 0;          ///< rad/s/sqrt(Hz); unused where the angular rate is a state
  double accelerometer_mps2_rthz = 0;  ///< m/s^2/sqrt(Hz)
  double rate_block_rthz = 0;          ///< rad/s^2/sqrt(Hz): walk of the gyro bias, or of the angular rate
};

/// Derivatives of one step, twelve rows each: by the state, by the rotation vector of the step, by the
/// velocity increment of the step.
struct StepDerivatives {
  Matrix12d state;
  Eigen::Matrix<double, 12, 3> rotation;
  Eigen::Matrix<double, 12, 3> velocity_increment;
};

/// Strapdown step with the attitude at mid-interval for the specific force. Moves pose and velocity of
/// `state` (nothing else) and returns the derivatives at its old value.
StepDerivatives advance(State& state, const InertialStep& step, double gravity_mps2, FilterModel model);

/// The covariance after the step.
Matrix12d propagated(const Matrix12d& covariance, const StepDerivatives& by, const ProcessNoise& noise,
                     double dt_s, FilterModel model);

}  // namespace understory
