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

/// Densities of the white noise of inputs and random walks. Over one interval each adds density^2 * dt to the
/// variance of its integral.
struct ProcessNoise {
  double gyro_radps_rthz = 0;          ///< rad/s/sqrt(Hz); unused where the angular rate is a state
  double accelerometer_mps2_rthz = 0;  ///< m/s^2/sqrt(Hz)
  double rate_block_rthz = 0;          ///< rad/s^2/sqrt(Hz): walk of the gyro bias, or of the angular rate
  double accelerometer_bias_walk_rthz = 0;  ///< m/s^3/sqrt(Hz)
  double wind_walk_rthz = 0;                ///< m/s^2/sqrt(Hz)
  double pitot_bias_walk_rthz = 0;          ///< m/s^2/sqrt(Hz)
  double barometer_offset_walk_m_rts = 0;   ///< m/sqrt(s)
  double gust_sigma_mps = 0;                ///< stationary, per axis
  double gust_time_s = 1;                   ///< its time constant
};

/// Rows that the step changes (attitude, velocity, position), and the number of states on which they depend
/// (the same, gyro bias, accelerometer bias).
inline constexpr int motion_rows = 9, moving_columns = 15;

/// Derivatives of the motion after one step with respect to the state before it, to the rotation vector of
/// the step, and to the velocity increment of the step.
struct StepDerivatives {
  Eigen::Matrix<double, motion_rows, moving_columns> state;
  Eigen::Matrix<double, motion_rows, 3> rotation;
  Eigen::Matrix<double, motion_rows, 3> velocity_increment;
};

/// Strapdown step that uses the attitude at mid-interval for the specific force. Changes pose, velocity and
/// dead reckoning of `state`, and returns the derivatives at its old value.
StepDerivatives advance(State& state, const InertialStep& step, double gravity_mps2, FilterModel model);

/// Propagates `covariance` over the step. Only the rows that the step changes are multiplied. The others keep
/// their values, except gusts, which decay.
void propagate(ErrorCovariance& covariance, const StepDerivatives& by, const ProcessNoise& noise, double dt_s,
               FilterModel model);

}  // namespace understory
