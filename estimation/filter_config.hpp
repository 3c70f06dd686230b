#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <utility>

#include "estimation/airspeed.hpp"
#include "estimation/altitude.hpp"
#include "estimation/angle_of_attack.hpp"
#include "estimation/error_state.hpp"
#include "estimation/ground_velocity.hpp"
#include "estimation/heading.hpp"
#include "estimation/rest.hpp"
#include "estimation/sideslip.hpp"

namespace understory {

/// Where the flight begins, and how well that is known. Standard deviations are one sigma.
struct StartConfig {
  /// m, -1e4..1e4: where the aircraft stands on the catapult: 1.5 m of rail, rising 0.20 rad, below the
  /// release point (0, 0, 1.5). The scenario sets it from its own catapult.
  Eigen::Vector3d position_world_m{-1.470, 0.0, 1.202};
  double yaw_rad = 0.0;  ///< rad, -3.15..3.15: left of world x
  double pitch_rad =
      0.20;  ///< rad, -1.5..1.5: nose up; replaced by the accelerometer's where the first sample is rest
  double roll_rad = 0.0;                       ///< rad, -3.15..3.15: left wing up; replaced as the pitch is
  bool in_flight = false;                      ///< no catapult: already flying, at the velocity below
  Eigen::Vector3d velocity_body_mps{0, 0, 0};  ///< m/s, -50..50
  double tilt_sigma_rad = 0.02;                ///< rad, 0..1
  double yaw_sigma_rad = 0.02;                 ///< rad, 0..3: the catapult is aimed within a degree
  double velocity_sigma_mps = 0.15;            ///< m/s, 0..10 (docs/sources.md [2] sigma0.vb)
  double horizontal_sigma_m = 0.01;  ///< m, 0..100: the catapult's place is the frame's origin by definition
  double vertical_sigma_m = 0.01;    ///< m, 0..100
  double gyro_bias_sigma_radps = 0.0087;  ///< rad/s, 0..1: consumer MEMS after factory calibration, 0.5 deg/s
};

/// The states beside the base's twelve, each a switch.
struct ExtraStatesConfig {
  bool accelerometer_bias = true;
  double accelerometer_bias_sigma_mps2 = 0.05;  ///< m/s^2, 0..5: consumer MEMS after calibration, 5 mg
  double accelerometer_bias_walk_rthz = 1e-3;   ///< m/s^3/sqrt(Hz), 0..1
  bool wind = false;
  double wind_sigma_mps = 3.0;   ///< m/s, 0..30, each of world x and y: what is expected before the launch
  double wind_walk_rthz = 0.05;  ///< m/s^2/sqrt(Hz), 0..10: how fast the mean wind may change
  bool gust = false;
  double gust_sigma_mps = 0.6;  ///< m/s, 0..20, per axis. MIL-F-8785C near the ground: 0.2 of the wind
  double gust_length_m = 30.0;  ///< m, 0.1..2000: MIL-F-8785C at 4 m; its time is this over the airspeed
  bool pitot_bias = true;
  double pitot_bias_sigma_mps = 0.1;   ///< m/s, 0..10: 1 Pa left by zeroing, at 12 m/s
  double pitot_bias_walk_rthz = 1e-3;  ///< m/s^2/sqrt(Hz), 0..1
};

/// What the filter does about sensors that fail.
struct DistrustConfig {
  double gate_probability = 0.999;  ///< 0.5..0.999999: of a good measurement to pass its chi-square gate
  double gate_patience_s = 0.25;    ///< s, 0..1e6: disagreement for longer is a fault
  bool exclude = true;  ///< a faulty sensor stays out until it has agreed as long; false: it is believed
  /// s, 0.001..1.5: an IMU interval longer than this is a loss: what happened meanwhile is guessed from both
  /// ends, and the guess is this uncertain. The scenario sets it to 1.5 intervals of its own IMU.
  double imu_gap_s = 0.0076;
  double gap_rate_sigma_radps = 2.0;  ///< rad/s, 0..50: of the mean rate over a gap
  double gap_force_sigma_mps2 = 5.0;  ///< m/s^2, 0..200: of the mean specific force over a gap
  double longest_gap_s = 0.25;        ///< s, 0.01..10: a longer silence of the IMU is integrated as this long
};

/// The error-state Kalman filter. Defaults fit a consumer IMU at 200 Hz, a 1 psi pitot and a barometer, tuned
/// for little drift of the relative position over 10 m of flight (docs/estimator.md).
struct FilterConfig {
  FilterModel model = FilterModel::gyro_bias;
  StartConfig start;
  double gravity_mps2 = 9.81;  ///< m/s^2, 1..20
  /// rad/s/sqrt(Hz), 0..1. Consumer MEMS: 0.01 deg/s/sqrt(Hz) = 1.7e-4; doubled for what sampling at 200 Hz
  /// loses.
  double gyro_noise_radps_rthz = 3.5e-4;
  /// m/s^2/sqrt(Hz), 0..10. Noise alone is 0.0035 (0.05 m/s^2 at 200 Hz); scale and vibration come on top.
  double accelerometer_noise_mps2_rthz = 0.01;
  double gyro_bias_walk_rthz = 1e-5;  ///< rad/s^2/sqrt(Hz), 0..1: a flight is too short for the bias to move
  /// rad/s^2/sqrt(Hz), 0..1000, angular_rate only: how freely the rate moves between gyro samples. The wing's
  /// roll accelerates at up to 50 rad/s^2 for 0.1 s.
  double rate_walk_rthz = 15.0;
  bool smooth_frame = true;         ///< in flight no correction moves position or heading, see FrameGain
  double max_rate_radps = 34.9;     ///< rad/s, 1..200: gyro's full scale (2000 deg/s); beyond is clamped
  double max_force_mps2 = 157.0;    ///< m/s^2, 20..2000: accelerometer's full scale (16 g); beyond is clamped
  double force_low_pass_hz = 30.0;  ///< Hz, 0.1..1000: of State::specific_force_body_mps2
  ExtraStatesConfig states;
  DistrustConfig distrust;
  AirspeedConfig airspeed;
  SideslipConfig sideslip;
  AngleOfAttackConfig angle_of_attack;
  AltitudeConfig altitude;
  HeadingConfig heading;
  GroundVelocityConfig gps;
  bool resightings = true;  ///< whether obstacles seen at a second depth, where there are any, are used
  RestConfig rest;
};

/// The original's filter (docs/sources.md [2], config/plane.cfg): the paper's 12 states, gyro 0.5
/// deg/s and accelerometer 0.2 m/s^2 of process noise, variances 15 (airspeed), 5 (v_y = 0) and 5
/// (altimeter), initial sigma 0.15 m/s, 3 deg, 0.5 m and 1 m. Every correction moves the position, as in a
/// textbook. Without catapult knowledge it had none of the rest either; the rest is kept, as the simulated
/// launch gives no other initial velocity.
FilterConfig original_filter();

/// For moving air: wind, gust and the sensors' own noise instead of margins. Its numbers come from flights
/// with 3 m/s of wind and Dryden turbulence (docs/estimator.md); in calm air it drifts about twice the
/// default's 0.06 m.
FilterConfig windy_filter();

template <typename Visitor>
void visit_fields(Visitor& visit, StartConfig& config) {
  visit("position_world_m", config.position_world_m, -1e4, 1e4);
  visit("yaw_rad", config.yaw_rad, -3.15, 3.15);
  visit("pitch_rad", config.pitch_rad, -1.5, 1.5);
  visit("roll_rad", config.roll_rad, -3.15, 3.15);
  visit("in_flight", config.in_flight);
  visit("velocity_body_mps", config.velocity_body_mps, -50.0, 50.0);
  visit("tilt_sigma_rad", config.tilt_sigma_rad, 0.0, 1.0);
  visit("yaw_sigma_rad", config.yaw_sigma_rad, 0.0, 3.0);
  visit("velocity_sigma_mps", config.velocity_sigma_mps, 0.0, 10.0);
  visit("horizontal_sigma_m", config.horizontal_sigma_m, 0.0, 100.0);
  visit("vertical_sigma_m", config.vertical_sigma_m, 0.0, 100.0);
  visit("gyro_bias_sigma_radps", config.gyro_bias_sigma_radps, 0.0, 1.0);
}

template <typename Visitor>
void visit_fields(Visitor& visit, ExtraStatesConfig& config) {
  visit("accelerometer_bias", config.accelerometer_bias);
  visit("accelerometer_bias_sigma_mps2", config.accelerometer_bias_sigma_mps2, 0.0, 5.0);
  visit("accelerometer_bias_walk_rthz", config.accelerometer_bias_walk_rthz, 0.0, 1.0);
  visit("wind", config.wind);
  visit("wind_sigma_mps", config.wind_sigma_mps, 0.0, 30.0);
  visit("wind_walk_rthz", config.wind_walk_rthz, 0.0, 10.0);
  visit("gust", config.gust);
  visit("gust_sigma_mps", config.gust_sigma_mps, 0.0, 20.0);
  visit("gust_length_m", config.gust_length_m, 0.1, 2000.0);
  visit("pitot_bias", config.pitot_bias);
  visit("pitot_bias_sigma_mps", config.pitot_bias_sigma_mps, 0.0, 10.0);
  visit("pitot_bias_walk_rthz", config.pitot_bias_walk_rthz, 0.0, 1.0);
}

template <typename Visitor>
void visit_fields(Visitor& visit, DistrustConfig& config) {
  visit("gate_probability", config.gate_probability, 0.5, 0.999999);
  visit("gate_patience_s", config.gate_patience_s, 0.0, 1e6);
  visit("exclude", config.exclude);
  visit("imu_gap_s", config.imu_gap_s, 0.001, 1.5);
  visit("gap_rate_sigma_radps", config.gap_rate_sigma_radps, 0.0, 50.0);
  visit("gap_force_sigma_mps2", config.gap_force_sigma_mps2, 0.0, 200.0);
  visit("longest_gap_s", config.longest_gap_s, 0.01, 10.0);
}

template <typename Visitor>
void visit_fields(Visitor& visit, FilterConfig& config) {
  visit("model", config.model,
        std::array<std::pair<std::string_view, FilterModel>, 2>{
            {{"gyro_bias", FilterModel::gyro_bias}, {"angular_rate", FilterModel::angular_rate}}});
  visit("start", config.start);
  visit("gravity_mps2", config.gravity_mps2, 1.0, 20.0);
  visit("gyro_noise_radps_rthz", config.gyro_noise_radps_rthz, 0.0, 1.0);
  visit("accelerometer_noise_mps2_rthz", config.accelerometer_noise_mps2_rthz, 0.0, 10.0);
  visit("gyro_bias_walk_rthz", config.gyro_bias_walk_rthz, 0.0, 1.0);
  visit("rate_walk_rthz", config.rate_walk_rthz, 0.0, 1000.0);
  visit("smooth_frame", config.smooth_frame);
  visit("max_rate_radps", config.max_rate_radps, 1.0, 200.0);
  visit("max_force_mps2", config.max_force_mps2, 20.0, 2000.0);
  visit("force_low_pass_hz", config.force_low_pass_hz, 0.1, 1000.0);
  visit("states", config.states);
  visit("distrust", config.distrust);
  visit("airspeed", config.airspeed);
  visit("sideslip", config.sideslip);
  visit("angle_of_attack", config.angle_of_attack);
  visit("altitude", config.altitude);
  visit("heading", config.heading);
  visit("gps", config.gps);
  visit("resightings", config.resightings);
  visit("rest", config.rest);
}

}  // namespace understory
