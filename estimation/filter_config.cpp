#include "estimation/filter_config.hpp"

#include "perception/field_visitor.hpp"

#include <cmath>

namespace understory {

FilterConfig windy_filter() {
  FilterConfig config;
  config.states.wind = config.states.gust = true;
  config.sideslip.model_error = 0.05;
  config.angle_of_attack.enabled = true;  // nothing else shows a vertical gust, which is no state
  return config;
}

FilterConfig original_filter() {
  constexpr double degree = M_PI / 180;
  FilterConfig config;
  config.model = FilterModel::angular_rate;
  config.states.accelerometer_bias = config.states.pitot_bias = false;
  config.rest.launch_speed_sigma_mps = 0.2;
  config.start.tilt_sigma_rad = config.start.yaw_sigma_rad = 3 * degree;
  config.start.velocity_sigma_mps = 0.15;
  config.start.horizontal_sigma_m = 0.5;
  config.start.vertical_sigma_m = 1.0;
  config.gyro_noise_radps_rthz = 0.5 * degree;
  config.accelerometer_noise_mps2_rthz = 0.2;
  config.smooth_frame = false;
  config.distrust.exclude = false;  // it had no gates to speak of
  config.airspeed.sigma_mps = std::sqrt(15.0);
  config.sideslip.model = SideslipModel::zero;
  config.sideslip.zero_sigma_mps = std::sqrt(5.0);
  config.altitude.sigma_m = std::sqrt(5.0);
  config.angle_of_attack.enabled = false;
  config.heading.enabled = false;
  return config;
}

void visit_fields(FieldVisitor& visit, AirspeedConfig& config) {
  visit("usable_mps", config.usable_mps, 0.0, 20.0,
        "pitot readings below this airspeed are ignored as inaccurate, unless the estimated airspeed exceeds "
        "1.5 times this");
  visit("sigma_mps", config.sigma_mps, 0.01, 10.0,
        "Standard deviation of one pitot reading at 12 m/s. At lower airspeeds it is larger, since pressure "
        "grows with the square of the speed. Pressure noise of 1.5 Pa and the sensor's resolution give 0.11 "
        "m/s; the bias is a separate state.");
}

void visit_fields(FieldVisitor& visit, SideslipConfig& config) {
  visit("model", config.model,
        std::array<std::pair<std::string_view, SideslipModel>, 3>{
            {{"lateral_force", SideslipModel::lateral_force},
             {"zero", SideslipModel::zero},
             {"off", SideslipModel::off}}},
        "How the sideways velocity is measured. lateral_force: from the winglets' side force; zero: assumed "
        "to be 0, as in the original; off: not at all.");
  visit("air_density_kgpm3", config.air_density_kgpm3, 0.1, 2.0, "air density that the filter assumes");
  visit("winglets_area_m2", config.winglets_area_m2, 1e-4, 2.0,
        "area of both winglets together | docs/sources.md [3]");
  visit("mass_kg", config.mass_kg, 0.05, 20.0, "mass that the filter assumes");
  visit("winglets_body_m", config.winglets_body_m, -5.0, 5.0,
        "mean position of the two winglets, in body axes from the centre of mass; y is 0 by symmetry");
  visit("sigma_mps2", config.sigma_mps2, 0.01, 50.0,
        "standard deviation of one reading of the lateral specific force");
  visit("model_error", config.model_error, 0.0, 1.0,
        "standard deviation of the side force model's error, as a share of the predicted force | "
        "docs/sources.md [15]");
  visit("zero_sigma_mps", config.zero_sigma_mps, 0.01, 50.0,
        "with `model: zero`, standard deviation of the assumed measurement that the sideways velocity is 0; "
        "the default is the original aircraft's");
}

void visit_fields(FieldVisitor& visit, AngleOfAttackConfig& config) {
  visit("enabled", config.enabled,
        "Corrects the angle of attack with the normal specific force. With a correct wing model it reduces "
        "the drift over 10 m by 0.01 m; with lift or mass 20 % wrong it adds up to 0.2 m. | "
        "docs/model_mismatch.md");
  visit("air_density_kgpm3", config.air_density_kgpm3, 0.1, 2.0, "air density that the filter assumes");
  visit("wing_area_m2", config.wing_area_m2, 0.01, 5.0, "wing area that the filter assumes");
  visit("mass_kg", config.mass_kg, 0.05, 20.0, "mass that the filter assumes");
  visit("pitch_damping_nmspr", config.pitch_damping_nmspr, 0.0, 10.0,
        "pitch damping that the filter assumes");
  visit("elevon_arm_m", config.elevon_arm_m, 0.01, 5.0,
        "distance of the elevons' force behind the centre of mass");
  visit("sigma_mps2", config.sigma_mps2, 0.01, 100.0,
        "Standard deviation of one reading of the normal specific force. It is large on purpose, because the "
        "error of a wrong wing model does not average out over 200 samples a second. With 1 m/s^2, a wing "
        "model 15 % wrong raises the drift over 10 m from 0.24 to 0.41 m (95th percentile, in dodges).");
  visit("model_error", config.model_error, 0.0, 1.0,
        "standard deviation of the normal force model's error, as a share of the predicted force");
}

void visit_fields(FieldVisitor& visit, AltitudeConfig& config) {
  visit("sigma_m", config.sigma_m, 0.01, 100.0,
        "standard deviation of one barometer reading: 0.3 m of noise and a resolution of 0.1 m");
  visit("offset_sigma_m", config.offset_sigma_m, 0.0, 10.0,
        "initial standard deviation of the barometer's offset, before the filter estimates it at rest on the "
        "catapult");
  visit("offset_walk_m_rts", config.offset_walk_m_rts, 0.0, 10.0,
        "random walk of the barometer's offset, which changes with weather and temperature");
  visit("wash_sigma_m_per_n", config.wash_sigma_m_per_n, 0.0, 10.0,
        "Initial standard deviation of the barometer error that the propeller causes, per newton of thrust. "
        "0: this error is not estimated.");
  visit("noise_m", config.noise_m, 0.01, 100.0,
        "standard deviation of one barometer reading in the separate filter that tracks the drift of the "
        "estimated height");
  visit("drift_walk_m_rts", config.drift_walk_m_rts, 0.0, 10.0,
        "random walk of the estimated height's drift, in the separate filter that tracks it with the "
        "barometer");
}

void visit_fields(FieldVisitor& visit, HeadingConfig& config) {
  visit("enabled", config.enabled,
        "uses the magnetometer; with smooth_frame it corrects the heading only before the launch, and other "
        "states in flight");
  visit("sigma_rad", config.sigma_rad, 0.01, 3.0,
        "Standard deviation of one magnetometer heading. It is large, because the main errors last the whole "
        "flight: a hard-iron error of 0.5 uT in a horizontal field of 19 uT turns the heading by 0.027 rad, "
        "and a tilt error turns it by 2.4 times the tilt.");
  visit("minimum_horizontal_ut", config.minimum_horizontal_ut, 0.0, 100.0,
        "magnetometer readings with a weaker horizontal field than this are ignored");
}

void visit_fields(FieldVisitor& visit, GroundVelocityConfig& config) {
  visit("enabled", config.enabled,
        "Corrects the velocity with GPS, where the aircraft has a receiver. Default on a course of over 100 "
        "m: false.");
  visit("sigma_mps", config.sigma_mps, 0.01, 10.0,
        "standard deviation of a GPS velocity, per axis | docs/sources.md [15]");
}

void visit_fields(FieldVisitor& visit, RestConfig& config) {
  visit("window_s", config.window_s, 0.01, 1.0,
        "length of the time window over which the filter tests whether the aircraft is at rest");
  visit("force_deviation_mps2", config.force_deviation_mps2, 0.01, 10.0,
        "rest test: largest standard deviation of the specific force within rest.window_s, per axis; five "
        "times the noise of one reading");
  visit("rate_deviation_radps", config.rate_deviation_radps, 1e-4, 1.0,
        "rest test: largest standard deviation of the angular rate within rest.window_s, per axis");
  visit("force_tolerance_mps2", config.force_tolerance_mps2, 0.01, 10.0,
        "rest test: largest difference between gravity and the magnitude of the mean specific force within "
        "rest.window_s");
  visit("rate_tolerance_radps", config.rate_tolerance_radps, 0.001, 5.0,
        "rest test: largest magnitude of the mean angular rate within rest.window_s; six times a gyro bias "
        "of 0.5 deg/s");
  visit("velocity_sigma_mps", config.velocity_sigma_mps, 1e-4, 1.0,
        "standard deviation of the zero velocity that the filter uses as a measurement at rest");
  visit("position_sigma_m", config.position_sigma_m, 1e-4, 1.0,
        "standard deviation of the known position that the filter uses as a measurement at rest");
  visit("force_sigma_mps2", config.force_sigma_mps2, 0.001, 10.0,
        "standard deviation of one accelerometer reading that the filter uses at rest to measure roll and "
        "pitch");
  visit("accelerometer_bias_mps2", config.accelerometer_bias_mps2, 0.0, 1.0,
        "Accelerometer bias, which at rest cannot be told from tilt. At the launch it adds to the "
        "uncertainty of roll and pitch, unless the filter estimates the bias.");
  visit("launch_threshold_mps2", config.launch_threshold_mps2, 5.0, 150.0,
        "The filter detects the launch when two IMU samples in a row exceed this specific force along body "
        "x. The original's threshold was 45; a rail of 1.5 m that accelerates to 12 m/s gives 48 plus a "
        "share of gravity. | docs/sources.md [2]");
  visit("launch_speed_sigma_mps", config.launch_speed_sigma_mps, 0.0, 5.0,
        "Standard deviation added to the forward speed at the launch, because the catapult's start and "
        "release each fall anywhere within a 5 ms sample interval at 48 m/s^2.");
}

void visit_fields(FieldVisitor& visit, StartConfig& config) {
  visit("position_world_m", config.position_world_m, -1e4, 1e4,
        "Position at the start, on the catapult: 1.5 m back along a rail that rises by 0.20 rad to the "
        "release point (0, 0, 1.5). The scenario computes it from its launch keys.");
  visit("yaw_rad", config.yaw_rad, -3.15, 3.15,
        "heading at the start: angle from world x, positive to the left");
  visit("pitch_rad", config.pitch_rad, -1.5, 1.5,
        "pitch at the start, positive nose up; the filter measures it again while at rest on the catapult");
  visit(
      "roll_rad", config.roll_rad, -3.15, 3.15,
      "roll at the start, positive left wing up; the filter measures it again while at rest on the catapult");
  visit("in_flight", config.in_flight,
        "starts the filter in flight, with start.velocity_body_mps; false: at rest on the catapult");
  visit("velocity_body_mps", config.velocity_body_mps, -50.0, 50.0,
        "velocity over ground at the start, in body axes; used only with start.in_flight");
  visit("tilt_sigma_rad", config.tilt_sigma_rad, 0.0, 1.0,
        "standard deviation of roll and pitch at the start");
  visit("yaw_sigma_rad", config.yaw_sigma_rad, 0.0, 3.0, "standard deviation of the heading at the start");
  visit("velocity_sigma_mps", config.velocity_sigma_mps, 0.0, 10.0,
        "initial standard deviation of the velocity, per axis | docs/sources.md [2]");
  visit("horizontal_sigma_m", config.horizontal_sigma_m, 0.0, 100.0,
        "standard deviation of x and y at the start");
  visit("vertical_sigma_m", config.vertical_sigma_m, 0.0, 100.0, "standard deviation of z at the start");
  visit("gyro_bias_sigma_radps", config.gyro_bias_sigma_radps, 0.0, 1.0,
        "initial standard deviation of the gyro's bias, per axis");
}

void visit_fields(FieldVisitor& visit, ExtraStatesConfig& config) {
  visit("accelerometer_bias", config.accelerometer_bias,
        "estimates the accelerometer's bias as three further states");
  visit("accelerometer_bias_sigma_mps2", config.accelerometer_bias_sigma_mps2, 0.0, 5.0,
        "initial standard deviation of the accelerometer's bias, per axis; 0.05 m/s^2 is 5 mg");
  visit("accelerometer_bias_walk_rthz", config.accelerometer_bias_walk_rthz, 0.0, 1.0,
        "random walk of the accelerometer bias |  | m/s^3/sqrt(Hz)");
  visit("wind", config.wind, "estimates the steady horizontal wind as two further states");
  visit("wind_sigma_mps", config.wind_sigma_mps, 0.0, 30.0,
        "initial standard deviation of the steady wind, per horizontal axis");
  visit("wind_walk_rthz", config.wind_walk_rthz, 0.0, 10.0,
        "random walk of the steady wind |  | m/s^2/sqrt(Hz)");
  visit("gust", config.gust, "estimates horizontal gusts as two further states");
  visit("gust_sigma_mps", config.gust_sigma_mps, 0.0, 20.0,
        "standard deviation of the gust velocity, per horizontal axis | MIL-F-8785C");
  visit("gust_length_m", config.gust_length_m, 0.1, 2000.0,
        "distance flown over which gusts decorrelate, the turbulence length scale (MIL-F-8785C, at a height "
        "of 4 m) | MIL-F-8785C");
  visit("pitot_bias", config.pitot_bias, "estimates the pitot tube's bias as one further state");
  visit("pitot_bias_sigma_mps", config.pitot_bias_sigma_mps, 0.0, 10.0,
        "initial standard deviation of the pitot tube's bias; 0.07 m/s is 1 Pa at 12 m/s");
  visit("pitot_bias_walk_rthz", config.pitot_bias_walk_rthz, 0.0, 1.0,
        "random walk of the pitot tube's bias |  | m/s^2/sqrt(Hz)");
}

void visit_fields(FieldVisitor& visit, DistrustConfig& config) {
  visit("gate_probability", config.gate_probability, 0.5, 0.999999,
        "probability that the outlier test (chi-square) accepts a measurement from a healthy sensor");
  visit("gate_patience_s", config.gate_patience_s, 0.0, 1e6,
        "a sensor counts as faulty once its measurements have failed the outlier test for longer than this");
  visit("exclude", config.exclude,
        "Ignores a faulty sensor until its measurements have passed the outlier test for gate_patience_s. "
        "false: uses its measurements although they fail the test.");
  visit("imu_gap_s", config.imu_gap_s, 0.001, 1.5,
        "Interval between IMU samples above which the filter assumes that samples were lost: it interpolates "
        "the motion and adds uncertainty. The scenario sets it to 1.5 sample intervals of its IMU.");
  visit("gap_rate_sigma_radps", config.gap_rate_sigma_radps, 0.0, 50.0,
        "standard deviation of the angular rate interpolated across lost IMU samples");
  visit("gap_force_sigma_mps2", config.gap_force_sigma_mps2, 0.0, 200.0,
        "standard deviation of the specific force interpolated across lost IMU samples");
  visit("longest_gap_s", config.longest_gap_s, 0.01, 10.0,
        "longest interval between IMU samples that the filter integrates in full; a longer one is integrated "
        "as this long");
}

void visit_fields(FieldVisitor& visit, FilterConfig& config) {
  visit("model", config.model,
        std::array<std::pair<std::string_view, FilterModel>, 2>{
            {{"gyro_bias", FilterModel::gyro_bias}, {"angular_rate", FilterModel::angular_rate}}},
        "Meaning of three of the filter's states. gyro_bias: the gyro's bias; angular_rate: the angular "
        "rate, which the gyro then measures, as in the original's filter. | docs/estimator.md");
  visit("start", config.start);
  visit("gravity_mps2", config.gravity_mps2, 1.0, 20.0, "gravity that the filter assumes");
  visit("gyro_noise_radps_rthz", config.gyro_noise_radps_rthz, 0.0, 1.0,
        "Noise density of the gyro. A consumer part has 0.01 deg/s/sqrt(Hz) = 1.7e-4; the default is twice "
        "that, because sampling at 200 Hz adds an error as large.");
  visit(
      "accelerometer_noise_mps2_rthz", config.accelerometer_noise_mps2_rthz, 0.0, 10.0,
      "Noise density of the accelerometer. Noise of 0.05 m/s^2 per sample at 200 Hz is a density of 0.0035.");
  visit("gyro_scale", config.gyro_scale, 0.0, 1.0,
        "Scale error and misalignment of the gyro, as a share of the angular rate. The error keeps its sign "
        "during a turn; the filter models it as noise that grows with the angular rate.");
  visit("accelerometer_scale", config.accelerometer_scale, 0.0, 1.0,
        "standard deviation of the accelerometer's scale error and misalignment. The filter models them as "
        "noise that grows with the difference between specific force and gravity.");
  visit("vibration_mps2pn", config.vibration_mps2pn, 0.0, 100.0,
        "amplitude of the propeller's vibration in the accelerometer, per newton of thrust.");
  visit("force_samples", config.force_samples, 1, 100,
        "Number of IMU samples that are averaged into one correction by the lateral or normal force. "
        "Averaging keeps vibration from biasing the estimated airspeed.");
  visit("gyro_bias_walk_rthz", config.gyro_bias_walk_rthz, 0.0, 1.0,
        "random walk of the gyro's bias |  | rad/s^2/sqrt(Hz)");
  visit("rate_walk_rthz", config.rate_walk_rthz, 0.0, 1000.0,
        "Random walk of the angular rate; used only with the model angular_rate. The aircraft's roll "
        "accelerates at up to 50 rad/s^2 for 0.1 s. |  | rad/s^2/sqrt(Hz)");
  visit("smooth_frame", config.smooth_frame,
        "keeps corrections in flight from changing position and heading, so that mapped obstacles stay in "
        "place; false: corrections change all states (FrameGain)");
  visit("max_rate_radps", config.max_rate_radps, 1.0, 200.0, "full scale of the gyro (2000 deg/s)");
  visit("max_force_mps2", config.max_force_mps2, 20.0, 2000.0, "full scale of the accelerometer (16 g)");
  visit("force_low_pass_hz", config.force_low_pass_hz, 0.1, 1000.0,
        "cut-off frequency of the low-pass filter on the specific force in the estimated state");
  visit("states", config.states);
  visit("distrust", config.distrust);
  visit("airspeed", config.airspeed);
  visit("sideslip", config.sideslip);
  visit("angle_of_attack", config.angle_of_attack);
  visit("altitude", config.altitude);
  visit("heading", config.heading);
  visit("gps", config.gps);
  visit("resightings", config.resightings,
        "corrects the velocity with the displacements that autopilot.resightings measures");
  visit("rest", config.rest);
}

}  // namespace understory
