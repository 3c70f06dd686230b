#pragma once

#include <Eigen/Core>

namespace understory {

class FieldVisitor;

/// Meaning of the states of rate_block.
enum class FilterModel {
  gyro_bias,     ///< the gyro is an input; its bias is estimated
  angular_rate,  ///< the paper's: angular rate is a state which the gyro measures (docs/sources.md [4])
};

/// The pitot tube measures the speed through the air along body x, plus a bias that remains after zeroing.
struct AirspeedConfig {
  double usable_mps = 6.0;
  double sigma_mps = 0.12;
};

enum class SideslipModel {
  lateral_force,  ///< from the winglets' side force
  zero,           ///< v_y = 0, the original's: false by up to 2.6 m/s in dodges (docs/sources.md [15])
  off,
};

/// Sideslip from lateral specific force. Only the winglets push sideways. As flat plates with a total area S
/// their force is normal to them: rho/2 V^2 S 2 sin(beta), with V and sin(beta) = v/V of the air in the
/// body's x-y plane at the winglets. So a_y = -k V v with k = rho S / m (docs/sources.md [3]: identified
/// flat-plate model).
struct SideslipConfig {
  SideslipModel model = SideslipModel::lateral_force;
  double air_density_kgpm3 = 1.204;
  double winglets_area_m2 = 0.038882;
  double mass_kg = 0.648412;
  Eigen::Vector3d winglets_body_m{-0.08, 0.0, 0.081954};
  double sigma_mps2 = 0.05;
  double model_error = 0.15;
  double zero_sigma_mps = 2.236;
};

/// Angle of attack from normal specific force. The wing is a flat plate of area S. Its force is normal to it:
/// rho/2 V^2 S 2 sin(alpha), with V and sin(alpha) = -w/V of the air in the body's x-z plane. So the wing's
/// a_z = -rho S V w / m. The wing has no moment about the centre of mass. In steady flight the elevons' force
/// therefore balances the pitch damping: D q / (arm m) (docs/sources.md [3], identified model; trim checks
/// within 0.1 %).
struct AngleOfAttackConfig {
  bool enabled = false;
  double air_density_kgpm3 = 1.204;
  double wing_area_m2 = 0.1811;
  double mass_kg = 0.648412;
  double pitch_damping_nmspr = 0.115;
  double elevon_arm_m = 0.145;
  double sigma_mps2 = 6.0;
  double model_error = 0.15;
};

/// The barometer measures world z plus an offset. The offset is a state; it is observed on the catapult,
/// where the altitude is known. The propeller's suction lowers the static pressure in proportion to the
/// thrust, so that the barometer reads too high by metres per newton: another state, if wash_sigma_m_per_n is
/// not zero.
struct AltitudeConfig {
  double sigma_m = 0.31;
  double offset_sigma_m = 0.3;
  double offset_walk_m_rts = 0.09;
  double wash_sigma_m_per_n = 0;
  double noise_m = 0.3;
  double drift_walk_m_rts = 0.1;
};

/// The magnetometer's field, rotated into the world by the estimated attitude (which compensates the tilt),
/// points to magnetic north, world y. Only its horizontal direction is used, not its strength or inclination.
struct HeadingConfig {
  bool enabled = true;
  double sigma_rad = 0.35;
  double minimum_horizontal_ut = 5.0;
};

/// Velocity over ground from GPS, measured at an earlier moment. The inertial sensors alone say how the
/// velocity has changed since, so that corrections made meanwhile are not applied twice.
struct GroundVelocityConfig {
  bool enabled = true;
  double sigma_mps = 0.2;
};

/// On the catapult the aircraft stands still at a known place: velocity and rate are zero, the specific force
/// is gravity.
struct RestConfig {
  double window_s = 0.1;
  double force_deviation_mps2 = 0.25;
  double rate_deviation_radps = 0.012;
  double force_tolerance_mps2 = 0.6;
  double rate_tolerance_radps = 0.05;
  double velocity_sigma_mps = 0.02;
  double position_sigma_m = 0.01;
  double force_sigma_mps2 = 0.1;
  double accelerometer_bias_mps2 = 0.05;
  double launch_threshold_mps2 = 30.0;
  double launch_speed_sigma_mps = 0.1;
};

/// Where the flight begins, and how well that is known. Standard deviations are one sigma.
struct StartConfig {
  Eigen::Vector3d position_world_m{-1.470, 0.0, 1.202};
  double yaw_rad = 0.0;
  double pitch_rad = 0.398;
  double roll_rad = 0.0;
  bool in_flight = false;
  Eigen::Vector3d velocity_body_mps{0, 0, 0};
  double tilt_sigma_rad = 0.02;
  double yaw_sigma_rad = 0.02;
  double velocity_sigma_mps = 0.15;
  double horizontal_sigma_m = 0.01;
  double vertical_sigma_m = 0.01;
  double gyro_bias_sigma_radps = 0.0087;
};

/// The states beside the basic twelve. Each kind can be switched on or off.
struct ExtraStatesConfig {
  bool accelerometer_bias = true;
  double accelerometer_bias_sigma_mps2 = 0.05;
  double accelerometer_bias_walk_rthz = 1e-3;
  bool wind = false;
  double wind_sigma_mps = 3.0;
  double wind_walk_rthz = 0.05;
  bool gust = false;
  double gust_sigma_mps = 0.6;
  double gust_length_m = 30.0;
  bool pitot_bias = true;
  double pitot_bias_sigma_mps = 0.07;
  double pitot_bias_walk_rthz = 1e-3;
};

/// What the filter does about sensors that fail.
struct DistrustConfig {
  double gate_probability = 0.999;
  double gate_patience_s = 0.25;
  bool exclude = true;
  double imu_gap_s = 0.0076;
  double gap_rate_sigma_radps = 2.0;
  double gap_force_sigma_mps2 = 5.0;
  double longest_gap_s = 0.25;
};

/// The error-state Kalman filter. Defaults fit a consumer IMU at 200 Hz, a 1 psi pitot and a barometer, tuned
/// for little drift of the relative position over 10 m of flight (docs/estimator.md).
struct FilterConfig {
  FilterModel model = FilterModel::gyro_bias;
  StartConfig start;
  double gravity_mps2 = 9.81;
  double gyro_noise_radps_rthz = 3.5e-4;
  double accelerometer_noise_mps2_rthz = 0.005;
  double gyro_scale = 0;
  double accelerometer_scale = 0;
  double vibration_mps2pn = 0;
  int force_samples = 1;
  double gyro_bias_walk_rthz = 1e-5;
  double rate_walk_rthz = 15.0;
  bool smooth_frame = true;
  double max_rate_radps = 34.9;
  double max_force_mps2 = 157.0;
  double force_low_pass_hz = 30.0;
  ExtraStatesConfig states;
  DistrustConfig distrust;
  AirspeedConfig airspeed;
  SideslipConfig sideslip;
  AngleOfAttackConfig angle_of_attack;
  AltitudeConfig altitude;
  HeadingConfig heading;
  GroundVelocityConfig gps;
  bool resightings = true;
  RestConfig rest;
};

/// The original's filter (docs/sources.md [2], config/plane.cfg): the paper's 12 states, gyro 0.5
/// deg/s and accelerometer 0.2 m/s^2 of process noise, variances 15 (airspeed), 5 (v_y = 0) and 5
/// (altimeter), initial sigma 0.15 m/s, 3 deg, 0.5 m and 1 m. Every correction moves the position, as in a
/// textbook. The original did not know the catapult and so had no corrections at rest. They are kept here,
/// because nothing else gives the initial velocity of the simulated launch.
FilterConfig original_filter();

/// For moving air: with wind and gust as states. Its numbers come from flights with 3 m/s of wind and Dryden
/// turbulence (docs/estimator.md); in calm air it drifts about twice as much as the default.
FilterConfig windy_filter();

void visit_fields(FieldVisitor& visit, FilterConfig& config);

}  // namespace understory
