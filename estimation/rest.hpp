#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// On the catapult the aircraft stands still at a known place: velocity and rate are zero, the specific force
/// is gravity.
struct RestConfig {
  double force_tolerance_mps2 = 0.6;  ///< m/s^2, 0.01..10: specific force this near gravity, and
  double rate_tolerance_radps =
      0.05;  ///< rad/s, 0.001..5: rates this near zero (bias 0.5 deg/s included) are rest
  double velocity_sigma_mps = 0.02;       ///< m/s, 1e-4..1
  double position_sigma_m = 0.01;         ///< m, 1e-4..1
  double force_sigma_mps2 = 0.1;          ///< m/s^2, 0.001..10: one reading's noise as a level
  double accelerometer_bias_mps2 = 0.05;  ///< m/s^2, 0..1: as a tilt it stays, however long the rest
  /// m/s^2, 5..150: a_x of two samples running. The original waited for 45 (docs/sources.md [2],
  /// accel_threshold_x); a 1.5 m rail to 12 m/s gives 48 and a share of gravity.
  double launch_threshold_mps2 = 30.0;
  /// m/s, 0..5: when in the sample interval the catapult fired, and when it let go, is unknown: each 48 m/s^2
  /// over 5 ms, evenly spread.
  double launch_speed_sigma_mps = 0.1;
};

template <typename Visitor>
void visit_fields(Visitor& visit, RestConfig& config) {
  visit("force_tolerance_mps2", config.force_tolerance_mps2, 0.01, 10.0);
  visit("rate_tolerance_radps", config.rate_tolerance_radps, 0.001, 5.0);
  visit("velocity_sigma_mps", config.velocity_sigma_mps, 1e-4, 1.0);
  visit("position_sigma_m", config.position_sigma_m, 1e-4, 1.0);
  visit("force_sigma_mps2", config.force_sigma_mps2, 0.001, 10.0);
  visit("accelerometer_bias_mps2", config.accelerometer_bias_mps2, 0.0, 1.0);
  visit("launch_threshold_mps2", config.launch_threshold_mps2, 5.0, 150.0);
  visit("launch_speed_sigma_mps", config.launch_speed_sigma_mps, 0.0, 5.0);
}

bool looks_at_rest(const ImuSample& sample, double gravity_mps2, const RestConfig& config);

Measurement<3> zero_velocity(const State& state, const RestConfig& config);
Measurement<3> known_position(const State& state, const Eigen::Vector3d& position_world_m,
                              const RestConfig& config);
Measurement<3> gravity_direction(const State& state, const Eigen::Vector3d& specific_force_body_mps2,
                                 double gravity_mps2, const RestConfig& config);
/// At rest a gyro reading is the gyro's bias. `sigma_radps`: noise of one reading.
Measurement<3> zero_rate(const State& state, const Eigen::Vector3d& gyro_radps, double sigma_radps);

/// True once: at the second consecutive sample whose forward specific force exceeds the threshold.
class LaunchDetector {
 public:
  explicit LaunchDetector(double threshold_mps2) : threshold_mps2_(threshold_mps2) {}
  bool fires(const ImuSample& sample);

 private:
  double threshold_mps2_;
  int running_ = 0;
};

}  // namespace understory
