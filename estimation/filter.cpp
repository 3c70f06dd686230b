#include "estimation/filter.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/measurements.hpp"
#include "estimation/so3.hpp"

namespace understory {
namespace {

/// Long enough for the way between two detection depths: 5 m in the slowest flight.
constexpr std::int64_t history_length_ns = 1'000'000'000;
constexpr double turn_s = 0.25;  // how long the aircraft rolls in a dodge

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
  state.altitude_m = start.position_world_m.z();
  const ExtraStatesConfig& extra = config.states;
  const auto prior = [](bool on, double sigma) { return on ? sigma : 0.0; };
  ErrorVector sigma;
  sigma << start.tilt_sigma_rad, start.tilt_sigma_rad, start.yaw_sigma_rad,
      Eigen::Vector3d::Constant(start.velocity_sigma_mps), start.horizontal_sigma_m, start.horizontal_sigma_m,
      start.vertical_sigma_m, Eigen::Vector3d::Constant(start.gyro_bias_sigma_radps),
      Eigen::Vector3d::Constant(prior(extra.accelerometer_bias, extra.accelerometer_bias_sigma_mps2)),
      Eigen::Vector2d::Constant(prior(extra.wind, extra.wind_sigma_mps)),
      Eigen::Vector2d::Constant(prior(extra.gust, extra.gust_sigma_mps)),
      prior(extra.pitot_bias, extra.pitot_bias_sigma_mps), config.altitude.offset_sigma_m,
      config.altitude.wash_sigma_m_per_n;
  state.covariance = sigma.cwiseAbs2().asDiagonal();
  return state;
}

/// The smallest rotation that takes a unit vector onto the z axis. Eigen's FromTwoVectors is the same to the
/// bit, but compiles a singular value decomposition for the vector straight down.
Eigen::Quaterniond turn_onto_z(const Eigen::Vector3d& unit) {
  const double twice_cosine = std::sqrt((1 + unit.z()) * 2);  // of half the angle
  if (twice_cosine < 1e-6) return Eigen::Quaterniond(0, 1, 0, 0);
  Eigen::Quaterniond turn;
  turn.vec() = unit.cross(Eigen::Vector3d::UnitZ()) * (1 / twice_cosine);
  turn.w() = twice_cosine * 0.5;
  return turn;
}

/// Roll and pitch from the measured gravity; yaw as configured.
Eigen::Matrix3d levelled(const Eigen::Vector3d& specific_force_body_mps2, double yaw_rad) {
  const Eigen::Matrix3d tilt = turn_onto_z(specific_force_body_mps2.normalized()).toRotationMatrix();
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
      rest_window_(config.rest, config.gravity_mps2),
      launch_detector_(config.rest.launch_threshold_mps2),
      altitude_drift_(config.altitude) {
  const DistrustConfig& distrust = config.distrust;
  const auto gate = [&](int degrees) {
    return Gate(chi_square_quantile(distrust.gate_probability, degrees), distrust.gate_patience_s,
                distrust.exclude ? Distrust::exclude : Distrust::believe);
  };
  gates_.assign(aid_count, gate(1));
  gates_[static_cast<std::size_t>(Aid::gps)] = gate(3);
  gates_[static_cast<std::size_t>(Aid::resighting)] = gate(2);
  history_.record(state_);
}

void Filter::on(const ImuSample& raw) {
  if (!raw.angular_rate_body_radps.allFinite() || !raw.specific_force_body_mps2.allFinite()) return;
  const ImuSample sample = clamped(raw, config_);
  if (!started_) return start(sample);
  if (sample.t_ns <= state_.t_ns) return;
  const double dt_s =
      std::min(1e-9 * static_cast<double>(sample.t_ns - state_.t_ns), config_.distrust.longest_gap_s);
  propagate(sample, dt_s);
  take_rates(sample, dt_s);
  if (launched()) {
    in_flight(sample);
    state_.distance_flown_m += state_.velocity_body_mps.norm() * dt_s;
    altitude_drift_.pass(dt_s);
  } else {
    on_catapult(sample, dt_s);
  }
  state_.altitude_m = state_.T_world_body.translation().z() + altitude_drift_.value_m();
  previous_ = sample;
  history_.record(state_);
}

void Filter::start(const ImuSample& sample) {
  started_ = true;
  previous_ = sample;
  state_.t_ns = sample.t_ns;
  state_.angular_rate_body_radps = sample.angular_rate_body_radps;
  state_.specific_force_body_mps2 = sample.specific_force_body_mps2;
  if (config_.start.in_flight)
    launch_t_ns_ = sample.t_ns;
  else
    rest_window_.rests_with(sample);
  history_.clear();
  history_.record(state_);
}

void Filter::propagate(const ImuSample& sample, double dt_s) {
  // Samples are instantaneous. Between two of them rate and force are taken as linear. Their mean alone would
  // miss that both turn with the body (coning and sculling), which exceeds the noise in a roll of 400 deg/s.
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
                                             previous_.specific_force_body_mps2) -
      state_.accelerometer_bias_mps2;
  const StepDerivatives by = advance(state_, step, config_.gravity_mps2, config_.model);
  const ProcessNoise noise = process_noise(step);
  understory::propagate(state_.covariance, by, noise, dt_s, config_.model);
  state_.gust_world_mps *= std::exp(-dt_s / noise.gust_time_s);
  state_.t_ns = sample.t_ns;
  if (launched() && dt_s > config_.distrust.imu_gap_s) ++imu_gaps_;
}

ProcessNoise Filter::process_noise(const InertialStep& step) const {
  const double dt_s = step.dt_s;
  const ExtraStatesConfig& extra = config_.states;
  const bool rate_is_state = config_.model == FilterModel::angular_rate;
  ProcessNoise noise;
  // An error of a constant share keeps its sign for as long as a turn or a pull-up lasts.
  const double root_of_turn = std::sqrt(turn_s);
  noise.gyro_radps_rthz = std::hypot(config_.gyro_noise_radps_rthz,
                                     config_.gyro_scale * step.angular_rate_body_radps.norm() * root_of_turn);
  noise.accelerometer_mps2_rthz =
      std::hypot(config_.accelerometer_noise_mps2_rthz,
                 config_.accelerometer_scale * root_of_turn *
                     (step.specific_force_body_mps2.norm() - config_.gravity_mps2));
  noise.rate_block_rthz = rate_is_state ? config_.rate_walk_rthz : config_.gyro_bias_walk_rthz;
  if (extra.accelerometer_bias) noise.accelerometer_bias_walk_rthz = extra.accelerometer_bias_walk_rthz;
  if (extra.wind) noise.wind_walk_rthz = extra.wind_walk_rthz;
  if (extra.pitot_bias) noise.pitot_bias_walk_rthz = extra.pitot_bias_walk_rthz;
  noise.barometer_offset_walk_m_rts = config_.altitude.offset_walk_m_rts;
  if (extra.gust) noise.gust_sigma_mps = extra.gust_sigma_mps;
  noise.gust_time_s = extra.gust_length_m / std::max(state_.velocity_body_mps.norm(), 1.0);
  if (dt_s > config_.distrust.imu_gap_s) {
    // A mean that is wrong by sigma over dt equals a noise density of sigma * sqrt(dt).
    const double root = std::sqrt(dt_s);
    noise.gyro_radps_rthz = std::hypot(noise.gyro_radps_rthz, config_.distrust.gap_rate_sigma_radps * root);
    noise.accelerometer_mps2_rthz =
        std::hypot(noise.accelerometer_mps2_rthz, config_.distrust.gap_force_sigma_mps2 * root);
  }
  return noise;
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
  correct(state_, gyro, config_.model, FrameGain::held);
}

/// Takes attitude and gyro bias from the window's means: the aircraft has rested for some samples, in which
/// nothing was corrected.
void Filter::settle(double dt_s) {
  const State start = starting_state(config_);
  const ImuSample& mean = rest_window_.mean();
  state_.covariance = start.covariance;
  state_.velocity_body_mps.setZero();
  state_.T_world_body.translation() = start.T_world_body.translation();
  state_.T_world_body.linear() = levelled(mean.specific_force_body_mps2, config_.start.yaw_rad);
  correct_at_rest(mean, dt_s, rest_window_.size());
}

void Filter::correct_at_rest(const ImuSample& mean, double dt_s, double samples) {
  const double root = std::sqrt(samples);
  correct(state_,
          gravity_direction(state_, mean.specific_force_body_mps2, config_.gravity_mps2,
                            config_.rest.force_sigma_mps2 / root),
          config_.model, FrameGain::free);
  if (config_.model != FilterModel::gyro_bias) return;
  const double sigma = std::max(config_.gyro_noise_radps_rthz, 1e-6) / std::sqrt(dt_s) / root;
  correct(state_, zero_rate(state_, mean.angular_rate_body_radps, sigma), config_.model, FrameGain::free);
}

void Filter::on_catapult(const ImuSample& sample, double dt_s) {
  const bool rested = at_rest_;
  at_rest_ = rest_window_.rests_with(sample);
  if (at_rest_ && !rested) {
    settle(dt_s);
  } else if (at_rest_) {
    correct(state_, zero_velocity(state_, config_.rest), config_.model, FrameGain::free);
    correct(state_, known_position(state_, config_.start.position_world_m, config_.rest), config_.model,
            FrameGain::free);
    correct_at_rest(sample, dt_s, 1);
  }
  // A soft launch never reaches the threshold. Flying speed counts as a launch too.
  const bool fired = launch_detector_.fires(sample);
  if (fired || state_.velocity_body_mps.x() > config_.airspeed.usable_mps) launch(sample.t_ns);
}

void Filter::launch(std::int64_t t_ns) {
  launch_t_ns_ = t_ns;
  at_rest_ = false;
  const RestConfig& rest = config_.rest;
  // Rest of any length leaves two things unknown: an accelerometer bias, which looks like tilt (where it is a
  // state, the correlation is known), and the moment of firing.
  const double tilt =
      config_.states.accelerometer_bias ? 0 : rest.accelerometer_bias_mps2 / config_.gravity_mps2;
  state_.covariance.diagonal().segment<2>(attitude_block).array() += tilt * tilt;
  state_.covariance(velocity_block, velocity_block) +=
      rest.launch_speed_sigma_mps * rest.launch_speed_sigma_mps;
}

void Filter::in_flight(const ImuSample& sample) {
  // While the catapult pushes, its rail carries the aircraft, so the forces do not come from the air.
  on_rail_ = sample.specific_force_body_mps2.x() > 0.5 * config_.rest.launch_threshold_mps2;
  if (on_rail_ || state_.velocity_body_mps.x() < config_.airspeed.usable_mps) return;
  if (config_.sideslip.model != SideslipModel::off)
    fuse_force(Aid::sideslip,
               sideslip(state_, sample.specific_force_body_mps2.y(), config_.sideslip, config_.model),
               sample.t_ns);
  if (config_.angle_of_attack.enabled)
    fuse_force(
        Aid::angle_of_attack,
        angle_of_attack(state_, sample.specific_force_body_mps2.z(), config_.angle_of_attack, config_.model),
        sample.t_ns);
}

void Filter::fuse_force(Aid aid, Measurement<1> measurement, std::int64_t t_ns) {
  ForceSum& sum = aid == Aid::sideslip ? lateral_force_ : normal_force_;
  sum.innovation += measurement.innovation[0];
  if (++sum.samples < config_.force_samples) return;
  const double samples = sum.samples;
  // Over some turns of the propeller a vibration adds up to less than its amplitude, at some phase.
  const double vibration_mps2 = config_.vibration_mps2pn * thrust_n_ / samples;
  measurement.innovation[0] = sum.innovation / samples;
  measurement.noise(0, 0) = measurement.noise(0, 0) / samples + 0.25 * vibration_mps2 * vibration_mps2;
  sum = {};
  fuse(aid, measurement, t_ns);
}

void Filter::on(const PitotSample& sample) {
  // On the rail the velocity lacks half an IMU sample of the catapult's push; the end of the push adds it.
  if (!launched() || on_rail_ || !std::isfinite(sample.airspeed_mps)) return;
  // Slow readings are poor. If the aircraft is not slow, they are a fault, which the gate must see.
  const bool is_slow = air_velocity(state_).body_mps.x() < 1.5 * config_.airspeed.usable_mps;
  if (is_slow && sample.airspeed_mps < config_.airspeed.usable_mps) return;
  if (fuse(Aid::airspeed, airspeed(state_, sample, config_.airspeed), sample.t_ns)) history_.record(state_);
}

void Filter::on(const BarometerSample& sample) {
  if (!std::isfinite(sample.altitude_m)) return;
  if (!launched() && !at_rest_) return;
  if (!fuse(Aid::altitude, altitude(state_, sample, thrust_n_, config_.altitude), sample.t_ns)) return;
  // The offset found at rest. The filter's estimate of it in flight is correlated with the drift.
  if (launched())
    altitude_drift_.observe(sample.altitude_m - resting_offset_m_ -
                            state_.barometer_wash_m_per_n * thrust_n_ -
                            state_.T_world_body.translation().z());
  else
    resting_offset_m_ = state_.barometer_offset_m;
  state_.altitude_m = state_.T_world_body.translation().z() + altitude_drift_.value_m();
  history_.record(state_);
}

void Filter::on(const MagnetometerSample& sample) {
  if (!started_ || !config_.heading.enabled || !sample.field_body_ut.allFinite()) return;
  if (horizontal_field_ut(state_, sample) < config_.heading.minimum_horizontal_ut) return;
  if (fuse(Aid::heading, heading(state_, sample, config_.heading), sample.t_ns)) history_.record(state_);
}

void Filter::on(const GpsSample& sample) {
  if (!launched() || !config_.gps.enabled || !sample.velocity_world_mps.allFinite()) return;
  if (sample.t_ns < *launch_t_ns_) return;
  if (fuse(Aid::gps, ground_velocity(state_, history_.at(sample.t_ns), sample, config_.gps), state_.t_ns))
    history_.record(state_);
}

void Filter::on(const ResightingSample& sample) {
  if (!launched() || !config_.resightings || !sample.discrepancy_world_m.allFinite()) return;
  const State earlier = history_.at(sample.earlier_ns), later = history_.at(sample.t_ns);
  if (earlier.t_ns != sample.earlier_ns || later.t_ns != sample.t_ns) return;  // older than the history
  if (fuse(Aid::resighting, ground_displacement(state_, earlier, later, sample), state_.t_ns))
    history_.record(state_);
}

void Filter::on(const ThrustSample& sample) {
  if (std::isfinite(sample.thrust_n)) thrust_n_ = sample.thrust_n;
}

template <int M>
bool Filter::fuse(Aid aid, const Measurement<M>& measurement, std::int64_t t_ns) {
  Gate& gate = gates_[static_cast<std::size_t>(aid)];
  const Weighed<M> weighed = weigh(state_, measurement);
  if (!gate.admits(weighed.innovation_squared, t_ns)) return false;
  const bool held = config_.smooth_frame && launched();
  correct(state_, measurement, weighed, config_.model, held ? FrameGain::held : FrameGain::free);
  return true;
}

}  // namespace understory
