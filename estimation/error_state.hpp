#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "estimation/state.hpp"

/// The twelve error states and the one update every measurement goes through.
namespace understory {

/// What the last three states are.
enum class FilterModel {
  gyro_bias,     ///< the gyro is an input; its bias is estimated (FACTS section 4)
  angular_rate,  ///< the paper's: angular rate is a state which the gyro measures (after Bry et al. 2012)
};

/// First row of each block in the error state, in the order of State::covariance.
enum ErrorBlock { attitude_block = 0, velocity_block = 3, position_block = 6, rate_block = 9 };

/// Derivative of the angular rate by the last block: a gyro bias is subtracted, an angular rate is itself.
constexpr double rate_sign(FilterModel model) { return model == FilterModel::gyro_bias ? -1.0 : 1.0; }

/// innovation = measured - predicted = jacobian * error + noise, with `noise` the covariance of the latter.
template <int M>
struct Measurement {
  Eigen::Matrix<double, M, 1> innovation = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, 12> jacobian = Eigen::Matrix<double, M, 12>::Zero();
  Eigen::Matrix<double, M, M> noise = Eigen::Matrix<double, M, M>::Identity();
};

/// Which parts of the position a correction may move. Position is an odometry frame in which obstacles seen
/// earlier rest: moving it for an error that has grown since the launch would carry the aircraft past its own
/// map.
enum class PositionGain { none, vertical, full };

/// Adds an error to the estimate (not to its covariance). The attitude's error is a body-frame rotation
/// vector.
void inject(State& state, const Vector12d& error, FilterModel model);

/// Squared innovation in units of its predicted spread: chi-square with M degrees of freedom where all is
/// well.
template <int M>
double normalized_innovation_squared(const State& state, const Measurement<M>& measurement) {
  const Eigen::Matrix<double, M, M> spread =
      measurement.jacobian * state.covariance * measurement.jacobian.transpose() + measurement.noise;
  return measurement.innovation.dot(spread.inverse() * measurement.innovation);
}

/// Kalman update in Joseph's form, which stays a true covariance for any gain, the withheld ones included.
template <int M>
void correct(State& state, const Measurement<M>& measurement, FilterModel model, PositionGain position) {
  const Eigen::Matrix<double, 12, M> cross = state.covariance * measurement.jacobian.transpose();
  const Eigen::Matrix<double, M, M> spread = measurement.jacobian * cross + measurement.noise;
  Eigen::Matrix<double, 12, M> gain = cross * spread.inverse();  // closed form up to four rows
  if (position != PositionGain::full) gain.template middleRows<2>(position_block).setZero();
  if (position == PositionGain::none) gain.row(position_block + 2).setZero();
  inject(state, gain * measurement.innovation, model);
  const Matrix12d rest = Matrix12d::Identity() - gain * measurement.jacobian;
  const Matrix12d updated =
      rest * state.covariance * rest.transpose() + gain * measurement.noise * gain.transpose();
  state.covariance = 0.5 * (updated + updated.transpose());
}

}  // namespace understory
