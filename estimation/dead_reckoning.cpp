#include "estimation/dead_reckoning.hpp"

#include "perception/field_visitor.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/so3.hpp"

namespace understory {
namespace {

constexpr std::int64_t history_ns = 1'000'000'000;

}  // namespace

DeadReckoning::DeadReckoning(const DeadReckoningConfig& config, const FilterConfig& filter)
    : config_(config), history_(history_ns), launch_detector_(filter.rest.launch_threshold_mps2) {
  const StartConfig& start = filter.start;
  state_.T_world_body.translation() = start.position_world_m;
  state_.T_world_body.linear() = (Eigen::AngleAxisd(start.yaw_rad, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-start.pitch_rad, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(start.roll_rad, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
  state_.altitude_m = start.position_world_m.z();
  history_.record(state_);
}

void DeadReckoning::on(const Sample& sample) {
  if (const auto* imu = std::get_if<ImuSample>(&sample)) on_imu(*imu);
  if (const auto* pitot = std::get_if<PitotSample>(&sample))
    if (std::isfinite(pitot->airspeed_mps)) airspeed_mps_ = std::max(0.0, pitot->airspeed_mps);
}

void DeadReckoning::on_imu(const ImuSample& sample) {
  if (!sample.angular_rate_body_radps.allFinite() || (previous_ns_ && sample.t_ns <= *previous_ns_)) return;
  const double dt_s = previous_ns_ ? seconds(sample.t_ns - *previous_ns_) : 0;
  previous_ns_ = state_.t_ns = sample.t_ns;
  launched_ = launch_detector_.fires(sample) || launched_;
  state_.specific_force_body_mps2 = sample.specific_force_body_mps2;
  if (!launched_) {
    ++resting_samples_;
    state_.gyro_bias_radps +=
        (sample.angular_rate_body_radps - state_.gyro_bias_radps) / static_cast<double>(resting_samples_);
  } else {
    state_.angular_rate_body_radps = sample.angular_rate_body_radps - state_.gyro_bias_radps;
    // The pitot measures along body x, the wing moves down by its angle of attack.
    state_.velocity_body_mps = airspeed_mps_ * Eigen::Vector3d(1, 0, -std::tan(config_.angle_of_attack_rad));
    state_.T_world_body.linear() =
        state_.T_world_body.linear() * so3::exp(dt_s * state_.angular_rate_body_radps);
    state_.T_world_body.translation() += dt_s * (state_.T_world_body.linear() * state_.velocity_body_mps);
    state_.altitude_m = state_.T_world_body.translation().z();
    state_.distance_flown_m += dt_s * state_.velocity_body_mps.norm();
  }
  history_.record(state_);
}

void visit_fields(FieldVisitor& visit, DeadReckoningConfig& config) {
  visit("angle_of_attack_rad", config.angle_of_attack_rad, -0.2, 0.8,
        "angle of attack that dead reckoning assumes in the whole flight: it turns the airspeed into a "
        "velocity");
}

}  // namespace understory
