#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimation/error_state.hpp"
#include "estimation/filter_config.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// The estimated velocity through the air, body axes: velocity over ground minus wind and gust (both level).
/// Pitot, winglets and wing respond to it.
struct AirVelocity {
  Eigen::Vector3d body_mps = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, error_states> jacobian = Eigen::Matrix<double, 3, error_states>::Zero();
};

AirVelocity air_velocity(const State& state);

Measurement<1> airspeed(const State& state, const PitotSample& sample, const AirspeedConfig& config);

/// `lateral_mps2` is the accelerometer's y. Precondition: config.model is not `off`, the airspeed is not
/// zero.
Measurement<1> sideslip(const State& state, double lateral_mps2, const SideslipConfig& config,
                        FilterModel model);

/// `normal_mps2` is the accelerometer's z. Precondition: the airspeed is not zero.
Measurement<1> angle_of_attack(const State& state, double normal_mps2, const AngleOfAttackConfig& config,
                               FilterModel model);

/// The height of the odometry frame's origin above the ground, followed slowly from the barometer. (No
/// correction moves the odometry's z itself.) A scalar Kalman filter of a random walk.
class AltitudeDrift {
 public:
  explicit AltitudeDrift(const AltitudeConfig& config) : config_(config) {}
  void pass(double dt_s) { variance_m2_ += config_.drift_walk_m_rts * config_.drift_walk_m_rts * dt_s; }
  /// `excess_m`: the barometer's altitude minus its offset minus the odometry's z.
  void observe(double excess_m);
  double value_m() const { return value_m_; }

 private:
  AltitudeConfig config_;
  double value_m_ = 0;
  double variance_m2_ = 0;
};

/// By how much the barometer reads too high: its offset, and the effect of the propeller's suction.
double barometer_excess_m(const State& state, double thrust_n);

Measurement<1> altitude(const State& state, const BarometerSample& sample, double thrust_n,
                        const AltitudeConfig& config);

/// Horizontal strength of the field for the estimated attitude, microtesla.
double horizontal_field_ut(const State& state, const MagnetometerSample& sample);

/// Innovation: by how much the aircraft's heading is left (counter-clockwise) of the estimate, rad, in (-pi,
/// pi]. The jacobian includes the tilt and is that of a field due north. Precondition: horizontal_field_ut >
/// 0.
Measurement<1> heading(const State& state, const MagnetometerSample& sample, const HeadingConfig& config);

/// `then` is the estimate recorded for the sample's moment.
Measurement<3> ground_velocity(const State& now, const State& then, const GpsSample& sample,
                               const GroundVelocityConfig& config);

/// How far the aircraft moved between two moments, according to an obstacle seen at two depths. The present
/// velocity, carried back by the inertial sensors, must have covered that distance. Level, world axes. The
/// two estimates are those recorded for the sample's two moments.
Measurement<2> ground_displacement(const State& now, const State& earlier, const State& later,
                                   const ResightingSample& sample);

/// The newest IMU samples before the launch. The aircraft is at rest if they hardly vary and their means fit
/// gyro bias and gravity. A constant bias is no motion.
class RestWindow {
 public:
  RestWindow(const RestConfig& config, double gravity_mps2) : config_(config), gravity_mps2_(gravity_mps2) {}
  /// Whether the aircraft is at rest, this sample included. False if samples are too few for a variance.
  bool rests_with(const ImuSample& sample);
  /// The mean of the window's samples, at the time of the newest.
  const ImuSample& mean() const { return mean_; }
  double size() const { return static_cast<double>(samples_.size()); }

 private:
  RestConfig config_;
  double gravity_mps2_;
  std::vector<ImuSample> samples_;
  ImuSample mean_;
};

Measurement<3> zero_velocity(const State& state, const RestConfig& config);
Measurement<3> known_position(const State& state, const Eigen::Vector3d& position_world_m,
                              const RestConfig& config);
/// `sigma_mps2`: standard deviation of the measured force.
Measurement<3> gravity_direction(const State& state, const Eigen::Vector3d& specific_force_body_mps2,
                                 double gravity_mps2, double sigma_mps2);
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
