#include "estimation/measurements.hpp"

#include <cmath>

#include "estimation/samples.hpp"
#include "estimation/so3.hpp"

namespace understory {

bool RestWindow::rests_with(const ImuSample& sample) {
  constexpr std::size_t fewest = 5;
  const std::int64_t window_ns = nanoseconds(config_.window_s);
  std::erase_if(samples_, [&](const ImuSample& old) { return old.t_ns <= sample.t_ns - window_ns; });
  samples_.push_back(sample);
  if (samples_.size() < fewest) return false;
  const double share = 1 / size();
  mean_ = {sample.t_ns, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const ImuSample& one : samples_) {
    mean_.angular_rate_body_radps += share * one.angular_rate_body_radps;
    mean_.specific_force_body_mps2 += share * one.specific_force_body_mps2;
  }
  Eigen::Vector3d rate_variance = Eigen::Vector3d::Zero(), force_variance = Eigen::Vector3d::Zero();
  for (const ImuSample& one : samples_) {
    rate_variance += share * (one.angular_rate_body_radps - mean_.angular_rate_body_radps).cwiseAbs2();
    force_variance += share * (one.specific_force_body_mps2 - mean_.specific_force_body_mps2).cwiseAbs2();
  }
  return std::sqrt(rate_variance.maxCoeff()) < config_.rate_deviation_radps &&
         std::sqrt(force_variance.maxCoeff()) < config_.force_deviation_mps2 &&
         mean_.angular_rate_body_radps.norm() < config_.rate_tolerance_radps &&
         std::abs(mean_.specific_force_body_mps2.norm() - gravity_mps2_) < config_.force_tolerance_mps2;
}

Measurement<3> zero_velocity(const State& state, const RestConfig& config) {
  Measurement<3> measurement;
  measurement.innovation = -state.velocity_body_mps;
  measurement.jacobian.middleCols<3>(velocity_block).setIdentity();
  measurement.noise *= config.velocity_sigma_mps * config.velocity_sigma_mps;
  return measurement;
}

Measurement<3> known_position(const State& state, const Eigen::Vector3d& position_world_m,
                              const RestConfig& config) {
  Measurement<3> measurement;
  measurement.innovation = position_world_m - state.T_world_body.translation();
  measurement.jacobian.middleCols<3>(position_block).setIdentity();
  measurement.noise *= config.position_sigma_m * config.position_sigma_m;
  return measurement;
}

Measurement<3> gravity_direction(const State& state, const Eigen::Vector3d& specific_force_body_mps2,
                                 double gravity_mps2, double sigma_mps2) {
  const Eigen::Vector3d up_body =
      state.T_world_body.linear().transpose() * Eigen::Vector3d(0, 0, gravity_mps2);
  Measurement<3> measurement;
  measurement.innovation = specific_force_body_mps2 - state.accelerometer_bias_mps2 - up_body;
  measurement.jacobian.middleCols<3>(attitude_block) = so3::skew(up_body);
  measurement.jacobian.middleCols<3>(accelerometer_bias_block).setIdentity();
  measurement.noise *= sigma_mps2 * sigma_mps2;
  return measurement;
}

Measurement<3> zero_rate(const State& state, const Eigen::Vector3d& gyro_radps, double sigma_radps) {
  Measurement<3> measurement;
  measurement.innovation = gyro_radps - state.gyro_bias_radps;
  measurement.jacobian.middleCols<3>(rate_block).setIdentity();
  measurement.noise *= sigma_radps * sigma_radps;
  return measurement;
}

bool LaunchDetector::fires(const ImuSample& sample) {
  running_ = sample.specific_force_body_mps2.x() > threshold_mps2_ ? running_ + 1 : 0;
  return running_ == 2;
}

}  // namespace understory
