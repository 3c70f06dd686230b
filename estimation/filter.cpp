#include "estimation/filter.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/so3.hpp"

namespace understory {
namespace {

constexpr std::int64_t history_length_ns = 500'000'000;

State starting_state(const FilterConfig& config) {
  const StartConfig& start = config.start;
  State state;
  state.T_world_body.translation() = start.position_world_m;
  // Nose up is a negative turn about the left-pointing y.
  state.T_world_body.linear() = (Eigen::AngleAxisd(start.yaw_rad, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(-start.pitch_rad, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(start.roll_rad, Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix();
  if (start.in_flight) state.velocity_body_mps = start.velocity_body_mps;
  Vector12d sigma;
  sigma << start.tilt_sigma_rad, start.tilt_sigma_rad, start.yaw_sigma_rad,
      Eigen::Vector3d::Constant(start.velocity_sigma_mps), start.horizontal_sigma_m, start.horizontal_sigma_m,
      start.vertical_sigma_m, Eigen::Vector3d::Constant(start.gyro_bias_sigma_radps);
  state.covariance = sigma.cwiseAbs2().asDiagonal();
  return state;
}

/// Levels by the felt gravity, keeping the configured yaw.
Eigen::Matrix3d levelled(const Eigen::Vector3d& specific_force_body_mps2, double yaw_rad) {
  const Eigen::Matrix3d tilt =
      Eigen::Quaterniond::FromTwoVectors(specific_force_body_mps2, Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  const double yaw_of_tilt = std::atan2(tilt(1, 0), tilt(0, 0));
  return Eigen::AngleAxisd(yaw_rad - yaw_of_tilt, Eigen::Vector3d::UnitZ()).toRotationMatrix() * tilt;
}

ImuSample clamped(const ImuSample& sample, const FilterConfig& config) {
  ImuSample within = sample;
  within.angular_rate_body_radps =
      sample.angular_rate_body_radps.cwiseMax(-config.max_rate_radps).cwiseMin(config.max_rate_radps);
  within.specific_force_body_mps2 =
      sample.specific_force_body_mps2.cwiseMax(-config.max_force_mps2).cwiseMin(config.max_force_mps2);
  return within;
}

}  // namespace

Filter::Filter(const FilterConfig& config)
    : config_(config),
      state_(starting_state(config)),
      history_(history_length_ns),
      launch_detector_(config.rest.launch_threshold_mps2),
      barometer_offset_(config.altitude.offset_sigma_m),
      airspeed_gate_(chi_square_quantile(config.gate_probability, 1), config.gate_patience_s),
      sideslip_gate_(airspeed_gate_),
      angle_of_attack_gate_(airspeed_gate_),
      altitude_gate_(airspeed_gate_),
      heading_gate_(airspeed_gate_) {
  history_.record(state_);
}

void Filter::on(const ImuSample& raw) {
  if (!raw.angular_rate_body_radps.allFinite() || !raw.specific_force_body_mps2.allFinite()) return;
  const ImuSample sample = clamped(raw, config_);
  if (!started_) return start(sample);
  if (sample.t_ns <= state_.t_ns) return;
  const double dt_s = std::min(1e-9 * static_cast<double>(sample.t_ns - state_.t_ns), config_.max_gap_s);
  propagate(sample, dt_s);
  take_rates(sample, dt_s);
  if (launched()) {
    in_flight(sample);
    state_.distance_flown_m += state_.velocity_body_mps.norm() * dt_s;
  } else {
    on_catapult(sample, dt_s);
  }
  previous_ = sample;
  history_.record(state_);
}

void Filter::start(const ImuSample& sample) {
  started_ = true;
  previous_ = sample;
  state_.t_ns = sample.t_ns;
  state_.angular_rate_body_radps = sample.angular_rate_body_radps;
  state_.specific_force_body_mps2 = sample.specific_force_body_mps2;
  if (config_.start.in_flight) {
    launch_t_ns_ = sample.t_ns;
  } else if (looks_at_rest(sample, config_.gravity_mps2, config_.rest)) {
    state_.T_world_body.linear() = levelled(sample.specific_force_body_mps2, config_.start.yaw_rad);
  }
  history_ = History(history_length_ns);
  history_.record(state_);
}

void Filter::propagate(const ImuSample& sample, double dt_s) {
  // Samples are values of a moment: between two of them both are taken as straight lines. The mean alone
  // would miss how rate and force turn with the body (coning and sculling), which in a 400 deg/s roll is more
  // than the noise.
  const Eigen::Vector3d before = previous_.angular_rate_body_radps - state_.gyro_bias_radps;
  const Eigen::Vector3d now = sample.angular_rate_body_radps - state_.gyro_bias_radps;
  const bool rate_is_state = config_.model == FilterModel::angular_rate;
  InertialStep step;
  step.dt_s = dt_s;
  step.angular_rate_body_radps =
      rate_is_state ? state_.angular_rate_body_radps : 0.5 * (before + now) + dt_s / 12 * before.cross(now);
  step.specific_force_body_mps2 =
      0.5 * (previous_.specific_force_body_mps2 + sample.specific_force_body_mps2) +
      dt_s / 12 *
          step.angular_rate_body_radps.cross(sample.specific_force_body_mps2 -
                                             previous_.specific_force_body_mps2);
  const StepDerivatives by = advance(state_, step, config_.gravity_mps2, config_.model);
  const ProcessNoise noise{config_.gyro_noise_radps_rthz, config_.accelerometer_noise_mps2_rthz,
                           rate_is_state ? config_.rate_walk_rthz : config_.gyro_bias_walk_rthz};
  state_.covariance = propagated(state_.covariance, by, noise, dt_s, config_.model);
  state_.t_ns = sample.t_ns;
}

void Filter::take_rates(const ImuSample& sample, double dt_s) {
  const double kept = std::exp(-2 * M_PI * config_.force_low_pass_hz * dt_s);
  state_.specific_force_body_mps2 =
      kept * state_.specific_force_body_mps2 + (1 - kept) * sample.specific_force_body_mps2;
  if (config_.model == FilterModel::gyro_bias) {
    state_.angular_rate_body_radps = sample.angular_rate_body_radps - state_.gyro_bias_radps;
    return;
  }
  Measurement<3> gyro;
  gyro.innovation = sample.angular_rate_body_radps - state_.angular_rate_body_radps;
  gyro.jacobian.middleCols<3>(rate_block).setIdentity();
  gyro.noise *= std::max(config_.gyro_noise_radps_rthz * config_.gyro_noise_radps_rthz / dt_s, 1e-12);
  correct(state_, gyro, config_.model, PositionGain::none);
}

void Filter::on_catapult(const ImuSample& sample, double dt_s) {
  at_rest_ = looks_at_rest(sample, config_.gravity_mps2, config_.rest);
  if (at_rest_) {
    const FilterModel model = config_.model;
    correct(state_, zero_velocity(state_, config_.rest), model, PositionGain::full);
    correct(state_, known_position(state_, config_.start.position_world_m, config_.rest), model,
            PositionGain::full);
    correct(state_,
            gravity_direction(state_, sample.specific_force_body_mps2, config_.gravity_mps2, config_.rest),
            model, PositionGain::full);
    if (model == FilterModel::gyro_bias) {
      const double sigma = std::max(config_.gyro_noise_radps_rthz, 1e-6) / std::sqrt(dt_s);
      correct(state_, zero_rate(state_, sample.angular_rate_body_radps, sigma), model, PositionGain::full);
    }
  }
  // A soft launch never reaches the threshold: flying speed is launch enough.
  const bool fired = launch_detector_.fires(sample);
  if (fired || state_.velocity_body_mps.x() > config_.airspeed.usable_mps) launch(sample.t_ns);
}

void Filter::launch(std::int64_t t_ns) {
  launch_t_ns_ = t_ns;
  at_rest_ = false;
  const RestConfig& rest = config_.rest;
  // What no length of rest reveals: an accelerometer bias, which passed for tilt, and the moment of firing.
  const double tilt = rest.accelerometer_bias_mps2 / config_.gravity_mps2;
  state_.covariance.diagonal().segment<2>(attitude_block).array() += tilt * tilt;
  state_.covariance(velocity_block, velocity_block) +=
      rest.launch_speed_sigma_mps * rest.launch_speed_sigma_mps;
}

void Filter::in_flight(const ImuSample& sample) {
  // While the catapult pushes, its rail carries the aircraft: the forces are not the air's.
  const bool on_rail = sample.specific_force_body_mps2.x() > 0.5 * config_.rest.launch_threshold_mps2;
  if (on_rail || state_.velocity_body_mps.x() < config_.airspeed.usable_mps) return;
  if (config_.sideslip.model != SideslipModel::off) {
    fuse(sideslip(state_, sample.specific_force_body_mps2.y(), config_.sideslip, config_.model),
         sideslip_gate_, PositionGain::none, sample.t_ns);
  }
  if (config_.angle_of_attack.enabled) {
    fuse(angle_of_attack(state_, sample.specific_force_body_mps2.z(), config_.angle_of_attack, config_.model),
         angle_of_attack_gate_, PositionGain::none, sample.t_ns);
  }
}

void Filter::on(const PitotSample& sample) {
  if (!launched() || !std::isfinite(sample.airspeed_mps) || sample.airspeed_mps < config_.airspeed.usable_mps)
    return;
  fuse(airspeed(state_, sample, config_.airspeed), airspeed_gate_, PositionGain::none, sample.t_ns);
}

void Filter::on(const BarometerSample& sample) {
  if (!std::isfinite(sample.altitude_m)) return;
  if (launched()) {
    fuse(altitude(state_, sample, barometer_offset_.value_m(), config_.altitude), altitude_gate_,
         PositionGain::vertical, sample.t_ns);
  } else if (at_rest_) {
    barometer_offset_.observe(sample.altitude_m - config_.start.position_world_m.z());
  }
}

void Filter::on(const MagnetometerSample& sample) {
  if (!started_ || !config_.heading.enabled || !sample.field_body_ut.allFinite()) return;
  if (horizontal_field_ut(state_, sample) < config_.heading.least_horizontal_ut) return;
  fuse(heading(state_, sample, config_.heading), heading_gate_, PositionGain::none, sample.t_ns);
}

void Filter::fuse(const Measurement<1>& measurement, Gate& gate, PositionGain position, std::int64_t t_ns) {
  if (!gate.admits(normalized_innovation_squared(state_, measurement), t_ns)) return;
  correct(state_, measurement, config_.model, config_.smooth_position ? position : PositionGain::full);
  history_.record(state_);
}

FilterConfig original_filter() {
  constexpr double degree = M_PI / 180;
  FilterConfig config;
  config.model = FilterModel::angular_rate;
  config.start.tilt_sigma_rad = config.start.yaw_sigma_rad = 3 * degree;
  config.start.velocity_sigma_mps = 0.15;
  config.start.horizontal_sigma_m = 0.5;
  config.start.vertical_sigma_m = 1.0;
  config.gyro_noise_radps_rthz = 0.5 * degree;
  config.accelerometer_noise_mps2_rthz = 0.2;
  config.smooth_position = false;
  config.airspeed.sigma_mps = std::sqrt(15.0);
  config.sideslip.model = SideslipModel::zero;
  config.sideslip.zero_sigma_mps = std::sqrt(5.0);
  config.altitude.sigma_m = std::sqrt(5.0);
  config.angle_of_attack.enabled = false;
  config.heading.enabled = false;
  return config;
}

}  // namespace understory
