#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "estimation/filter_config.hpp"
#include "estimation/state.hpp"

/// The update that every measurement uses.
namespace understory {

/// Derivative of the angular rate by the rate block: -1 for a gyro bias, which is subtracted, +1 for an
/// angular rate.
constexpr double rate_sign(FilterModel model) { return model == FilterModel::gyro_bias ? -1.0 : 1.0; }

/// innovation = measured - predicted = jacobian * error + noise, with `noise` the covariance of the latter.
template <int M>
struct Measurement {
  Eigen::Matrix<double, M, 1> innovation = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, error_states> jacobian = Eigen::Matrix<double, M, error_states>::Zero();
  Eigen::Matrix<double, M, M> noise = Eigen::Matrix<double, M, M>::Identity();
};

/// Which parts of the pose a correction may change. The pose is in an odometry frame, in which obstacles seen
/// earlier rest. A correction for an error that has grown since the launch, or a turn about the vertical,
/// would move the aircraft relative to its own map.
enum class FrameGain {
  held,  ///< neither position nor heading; roll and pitch, which gravity observes, may be corrected
  free,  ///< all of the pose, as in a textbook filter
};

/// Adds an error to the estimate (not to its covariance). The attitude's error is a body-frame rotation
/// vector.
void inject(State& state, const ErrorVector& error, FilterModel model);

/// A measurement compared with the estimate: what its gate and its gain need.
template <int M>
struct Weighed {
  Eigen::Matrix<double, error_states, M> cross;  ///< covariance of error and innovation, P H'
  Eigen::Matrix<double, M, M> spread;            ///< predicted covariance of the innovation, H P H' + noise
  Eigen::Matrix<double, M, M> inverse_spread;
  /// Squared innovation in units of its spread: chi-square with M degrees of freedom if the filter is
  /// consistent.
  double innovation_squared = 0;
};

template <int M>
Weighed<M> weigh(const State& state, const Measurement<M>& measurement) {
  Weighed<M> weighed;
  weighed.cross.setZero();
  weighed.spread = measurement.noise;
  // A measurement depends on few states. Only their columns are visited.
  for (int error = 0; error < error_states; ++error) {
    const auto by_error = measurement.jacobian.col(error);
    if ((by_error.array() != 0).any())
      weighed.cross += state.covariance.col(error).lazyProduct(by_error.transpose());
  }
  weighed.spread += measurement.jacobian.lazyProduct(weighed.cross);
  weighed.inverse_spread = weighed.spread.inverse();  // closed form up to four rows
  weighed.innovation_squared = measurement.innovation.dot(weighed.inverse_spread * measurement.innovation);
  return weighed;
}

/// Kalman update. The covariance uses Joseph's form (I - K H) P (I - K H)' + K R K', which holds for any gain
/// K, also with rows set to zero. Multiplied out: P - D - D' with D = K (P H' - K S / 2)'.
template <int M>
void correct(State& state, const Measurement<M>& measurement, const Weighed<M>& weighed, FilterModel model,
             FrameGain frame) {
  Eigen::Matrix<double, error_states, M> gain = weighed.cross.lazyProduct(weighed.inverse_spread);
  if (frame == FrameGain::held) {
    gain.template middleRows<3>(position_block).setZero();
    const Eigen::Vector3d up_body = state.T_world_body.linear().row(2);
    gain.template middleRows<3>(attitude_block) -=
        up_body * (up_body.transpose() * gain.template middleRows<3>(attitude_block)).eval();
  }
  inject(state, gain * measurement.innovation, model);
  const Eigen::Matrix<double, error_states, M> half = weighed.cross - 0.5 * gain.lazyProduct(weighed.spread);
  for (int column = 0; column < error_states; ++column)
    for (int row = 0; row < M; ++row)
      state.covariance.col(column) -= half(column, row) * gain.col(row) + gain(column, row) * half.col(row);
}

template <int M>
void correct(State& state, const Measurement<M>& measurement, FilterModel model, FrameGain frame) {
  correct(state, measurement, weigh(state, measurement), model, frame);
}

}  // namespace understory
