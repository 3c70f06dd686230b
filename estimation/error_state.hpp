#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "estimation/state.hpp"

/// The one update every measurement goes through.
namespace understory {

/// What the states of rate_block are.
enum class FilterModel {
  gyro_bias,     ///< the gyro is an input; its bias is estimated (FACTS section 4)
  angular_rate,  ///< the paper's: angular rate is a state which the gyro measures (after Bry et al. 2012)
};

/// Derivative of the angular rate by the rate block: a gyro bias is subtracted, an angular rate is itself.
constexpr double rate_sign(FilterModel model) { return model == FilterModel::gyro_bias ? -1.0 : 1.0; }

/// innovation = measured - predicted = jacobian * error + noise, with `noise` the covariance of the latter.
template <int M>
struct Measurement {
  Eigen::Matrix<double, M, 1> innovation = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, error_states> jacobian = Eigen::Matrix<double, M, error_states>::Zero();
  Eigen::Matrix<double, M, M> noise = Eigen::Matrix<double, M, M>::Identity();
};

/// Which parts of the pose a correction may move. The pose lives in an odometry frame in which obstacles seen
/// earlier rest: moving it for an error that has grown since the launch, or turning it about the vertical,
/// would carry the aircraft past its own map.
enum class FrameGain {
  held,  ///< neither the position nor the heading; roll and pitch, which gravity shows, may be corrected
  free,  ///< all of it, as in a textbook
};

/// Adds an error to the estimate (not to its covariance). The attitude's error is a body-frame rotation
/// vector.
void inject(State& state, const ErrorVector& error, FilterModel model);

/// Squared innovation in units of its predicted spread: chi-square with M degrees of freedom where all is
/// well.
template <int M>
double normalized_innovation_squared(const State& state, const Measurement<M>& measurement) {
  const Eigen::Matrix<double, M, M> spread =
      measurement.jacobian * state.covariance * measurement.jacobian.transpose() + measurement.noise;
  return measurement.innovation.dot(spread.inverse() * measurement.innovation);
}

/// Kalman update. The covariance's is Joseph's form (I - K H) P (I - K H)' + K R K', true for any gain K, the
/// withheld ones included, multiplied out: P - D - D' with D = K (P H' - K S / 2)'.
template <int M>
void correct(State& state, const Measurement<M>& measurement, FilterModel model, FrameGain frame) {
  const Eigen::Matrix<double, error_states, M> cross = state.covariance * measurement.jacobian.transpose();
  const Eigen::Matrix<double, M, M> spread = measurement.jacobian * cross + measurement.noise;
  Eigen::Matrix<double, error_states, M> gain = cross * spread.inverse();  // closed form up to four rows
  if (frame == FrameGain::held) {
    gain.template middleRows<3>(position_block).setZero();
    const Eigen::Vector3d up_body = state.T_world_body.linear().row(2);
    gain.template middleRows<3>(attitude_block) -=
        up_body * (up_body.transpose() * gain.template middleRows<3>(attitude_block)).eval();
  }
  inject(state, gain * measurement.innovation, model);
  const Eigen::Matrix<double, error_states, M> half = cross - 0.5 * gain * spread;
  const ErrorCovariance less = gain * half.transpose();
  state.covariance -= less + less.transpose();
}

}  // namespace understory
