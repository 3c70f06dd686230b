#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace understory {

/// Six-axis IMU of the consumer class (InvenSense MPU-6000 product specification 3.4, ICM-20602 1.0). A
/// sample is the truth of its physics step plus errors. No internal filter is modelled, so the noise per
/// sample is that after the sensor's low-pass. Readings saturate at the range and are rounded to the
/// resolution. Effects at zero are off; the grade `consumer` sets those of a real part
/// (sim/sensors/sensor_grades.hpp, docs/sensors.md).
struct ImuConfig {
  double gyro_noise_radps = 0.0024;
  double gyro_bias_radps = 0.0087;
  double gyro_bias_instability_radps = 0;
  double gyro_walk_radpsps_rthz = 0;
  double gyro_scale = 0;
  double gyro_misalignment = 0;
  double gyro_vibration_radpspn = 0;
  double gyro_range_radps = 17.4533;
  double gyro_step_radps = 0.000532;
  double accelerometer_noise_mps2 = 0.05;
  double accelerometer_bias_mps2 = 0.05;
  double accelerometer_bias_instability_mps2 = 0;
  double accelerometer_walk_mps2ps_rthz = 0;
  double accelerometer_scale = 0;
  double accelerometer_misalignment = 0;
  double accelerometer_vibration_mps2pn = 0;
  double accelerometer_range_mps2 = 156.9;
  double accelerometer_step_mps2 = 0.00479;
  double propeller_hz_at_1n = 70;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ImuConfig& config) {
  visit("gyro_noise_radps", config.gyro_noise_radps, 0.0, 1.0,
        "rms noise of one gyro sample, per axis: 0.01 deg/s/sqrt(Hz) at 200 Hz");
  visit("gyro_bias_radps", config.gyro_bias_radps, 0.0, 1.0,
        "standard deviation of the gyro's bias, constant in a flight: 0.5 deg/s");
  visit("gyro_bias_instability_radps", config.gyro_bias_instability_radps, 0.0, 0.1,
        "bias instability of the gyro: the floor of its Allan deviation");
  visit("gyro_walk_radpsps_rthz", config.gyro_walk_radpsps_rthz, 0.0, 0.1,
        "rate random walk of the gyro's bias (K of IEEE 952)");
  visit("gyro_scale", config.gyro_scale, 0.0, 0.3,
        "standard deviation of the gyro's scale factor error, per axis; 0.01: one per cent");
  visit("gyro_misalignment", config.gyro_misalignment, 0.0, 0.3,
        "standard deviation of the gyro's cross-axis sensitivity");
  visit("gyro_vibration_radpspn", config.gyro_vibration_radpspn, 0.0, 10.0,
        "amplitude of the propeller's vibration in the gyro, per newton of thrust");
  visit("gyro_range_radps", config.gyro_range_radps, 0.1, 100.0,
        "largest rate that the gyro measures: 1000 deg/s");
  visit("gyro_step_radps", config.gyro_step_radps, 0.0, 0.1,
        "resolution of the gyro: plus and minus 1000 deg/s in 16 bits");
  visit("accelerometer_noise_mps2", config.accelerometer_noise_mps2, 0.0, 10.0,
        "rms noise of one accelerometer sample, per axis: 360 ug/sqrt(Hz) at 200 Hz");
  visit("accelerometer_bias_mps2", config.accelerometer_bias_mps2, 0.0, 10.0,
        "standard deviation of the accelerometer's bias, constant in a flight: 5 mg");
  visit("accelerometer_bias_instability_mps2", config.accelerometer_bias_instability_mps2, 0.0, 1.0,
        "bias instability of the accelerometer: the floor of its Allan deviation");
  visit("accelerometer_walk_mps2ps_rthz", config.accelerometer_walk_mps2ps_rthz, 0.0, 1.0,
        "random walk of the accelerometer's bias");
  visit("accelerometer_scale", config.accelerometer_scale, 0.0, 0.3,
        "standard deviation of the accelerometer's scale factor error, per axis");
  visit("accelerometer_misalignment", config.accelerometer_misalignment, 0.0, 0.3,
        "standard deviation of the accelerometer's cross-axis sensitivity");
  visit("accelerometer_vibration_mps2pn", config.accelerometer_vibration_mps2pn, 0.0, 100.0,
        "amplitude of the propeller's vibration in the accelerometer, per newton of thrust");
  visit("accelerometer_range_mps2", config.accelerometer_range_mps2, 10.0, 1000.0,
        "largest specific force that the accelerometer measures: 16 g");
  visit("accelerometer_step_mps2", config.accelerometer_step_mps2, 0.0, 1.0,
        "resolution of the accelerometer: 2048 counts per g");
  visit("propeller_hz_at_1n", config.propeller_hz_at_1n, 1.0, 1000.0,
        "Frequency of the propeller's vibration at 1 N of thrust; it grows with the square root of the "
        "thrust. 1 / (D^2 sqrt(C_T rho)) with an 8 inch propeller (0.203 m) and a thrust coefficient of 0.1 "
        "(typical).");
}

/// Pitot tube on a differential pressure sensor of 1 psi (TE/MEAS MS4525DO, total error band 1 % of span
/// before zeroing; 14 bits over +-1 psi). The tube points along body x and measures the dynamic pressure of
/// the air's speed along it. Airspeed is the root of the pressure, so below about 4 to 5 m/s (10 to 15 Pa)
/// noise and bias dominate.
struct PitotConfig {
  double pressure_noise_pa = 1.5;
  double pressure_bias_pa = 1.0;
  double pressure_range_pa = 6894;
  double pressure_step_pa = 1.05;
  double bias_mps = 0.0;
  double dead_zone_pa = 0;
  double recovery_angle_rad = 0.26;
  double recovery_loss = 0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, PitotConfig& config) {
  visit("pressure_noise_pa", config.pressure_noise_pa, 0.0, 1000.0, "noise of one pressure sample, rms");
  visit("pressure_bias_pa", config.pressure_bias_pa, 0.0, 1000.0,
        "standard deviation of the pressure bias that remains after zeroing on the ground");
  visit("pressure_range_pa", config.pressure_range_pa, 10.0, 100000.0,
        "largest differential pressure that the sensor measures: 1 psi");
  visit("pressure_step_pa", config.pressure_step_pa, 0.0, 100.0,
        "resolution of the pressure: the span from -1 to 1 psi in 13107 counts");
  visit("bias_mps", config.bias_mps, -20.0, 20.0,
        "constant offset added to the measured airspeed, for experiments");
  visit("dead_zone_pa", config.dead_zone_pa, 0.0, 1000.0,
        "differential pressure below which the reading is set to zero, as drivers do on the ground");
  visit("recovery_angle_rad", config.recovery_angle_rad, 0.0, 1.58,
        "Largest angle between airflow and tube without a pressure loss. Total-pressure tubes keep within 1 "
        "% up to about 10 to 25 deg, by the shape of the nose (Gracey, Letko & Russell 1951, NACA TN 2331). "
        "| Gracey, Letko & Russell 1951");
  visit("recovery_loss", config.recovery_loss, 0.0, 100.0,
        "Share of the pressure lost per square radian of airflow angle beyond recovery_angle_rad. 2: a "
        "quarter is lost 20 deg beyond it (typical); 0: no loss.");
}

/// Barometer (MEAS MS5611-01BA03: 0.012 to 0.065 mbar rms, a count is about 10 cm) read in the slipstream:
/// 0.3 m of noise, and an offset that wanders as a first-order Gauss-Markov process, zero at the first
/// sample.
struct BarometerConfig {
  double noise_m = 0.3;
  double step_m = 0.1;
  double drift_m = 0.5;
  double drift_time_s = 60.0;
  double wash_m_per_n = 0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, BarometerConfig& config) {
  visit("noise_m", config.noise_m, 0.0, 20.0, "rms noise of one altitude sample");
  visit("step_m", config.step_m, 0.0, 10.0, "resolution of the altitude");
  visit("drift_m", config.drift_m, 0.0, 50.0, "standard deviation of the altitude's slow drift");
  visit("drift_time_s", config.drift_time_s, 0.1, 10000.0,
        "time constant of the altitude's slow drift (weather, heat)");
  visit("wash_m_per_n", config.wash_m_per_n, -10.0, 10.0,
        "Altitude error per newton of thrust; positive: reads too high. At a distance x ahead of the "
        "propeller, suction lowers the static pressure by T / 2A times 1 - x / sqrt(x^2 + R^2) (momentum "
        "theory). An 8 inch disc (A = 0.032 m^2) makes 15.4 Pa per newton at the disc. At 11.8 Pa per metre "
        "this is 1.3 m of altitude, 0.39 m at x = 0.1 m and 0.14 m at 0.2 m.");
}

/// Magnetometer (Honeywell HMC5883L: 0.2 uT rms at best, 0.073 uT a count at its standard gain, +-130 uT)
/// near a motor: 0.5 uT of noise and of hard iron left after calibration. The field is that of northern
/// mid-latitudes, towards world +y and down.
struct MagnetometerConfig {
  double field_ut = 48.0;
  double inclination_rad = 1.16937;
  double noise_ut = 0.5;
  double hard_iron_ut = 0.5;
  double soft_iron = 0;
  double range_ut = 130.0;
  double step_ut = 0.073;
};

template <typename Visitor>
void visit_fields(Visitor& visit, MagnetometerConfig& config) {
  visit("field_ut", config.field_ut, 10.0, 100.0, "strength of the magnetic field");
  visit("inclination_rad", config.inclination_rad, -1.58, 1.58,
        "angle of the field below the horizon: 67 deg");
  visit("noise_ut", config.noise_ut, 0.0, 100.0, "rms noise of one magnetometer sample, per axis");
  visit("hard_iron_ut", config.hard_iron_ut, 0.0, 100.0,
        "standard deviation of the hard-iron bias, constant in a flight, per axis");
  visit("soft_iron", config.soft_iron, 0.0, 0.5,
        "Standard deviation of the six independent elements of the symmetric matrix that distorts the field "
        "(soft iron and scale error), relative to the field.");
  visit("range_ut", config.range_ut, 10.0, 10000.0, "largest field that the magnetometer measures, per axis");
  visit("step_ut", config.step_ut, 0.0, 10.0, "resolution of the field; 0: exact");
}

/// Satellite receiver of the consumer class (u-blox M8: 2.5 m circular error of position, 0.05 m/s of
/// velocity at best; 5 Hz, 0.2 s late and 0.2 m/s among trees on an aircraft that turns). Most of the
/// position's error wanders with satellites and reflections: a first-order Gauss-Markov process that starts
/// in its stationary distribution. Across a forest it is nearly constant.
struct GpsConfig {
  bool enabled = false;
  double delay_s = 0.2;
  double velocity_noise_mps = 0.2;
  double position_noise_m = 0.3;
  double position_drift_m = 2.1;
  double position_drift_time_s = 60;
  double vertical_factor = 1.5;
};

template <typename Visitor>
void visit_fields(Visitor& visit, GpsConfig& config) {
  visit("enabled", config.enabled,
        "whether the aircraft has a GPS receiver; the original aircraft avoided obstacles without one");
  visit("delay_s", config.delay_s, 0.0, 2.0, "time from the measurement of a fix to its arrival");
  visit("velocity_noise_mps", config.velocity_noise_mps, 0.0, 20.0, "rms noise of a GPS velocity, per axis");
  visit("position_noise_m", config.position_noise_m, 0.0, 100.0,
        "rms white noise of a GPS position, per horizontal axis (typical)");
  visit("position_drift_m", config.position_drift_m, 0.0, 100.0,
        "standard deviation of the GPS position's slow drift, per horizontal axis");
  visit("position_drift_time_s", config.position_drift_time_s, 0.1, 10000.0,
        "time constant of the GPS position's slow drift (typical)");
  visit("vertical_factor", config.vertical_factor, 1.0, 10.0,
        "ratio of the vertical to the horizontal GPS position error (typical)");
}

/// Rates must divide 1200 Hz (divides_physics_rate; whoever loads a scenario checks).
struct SensorsConfig {
  int imu_rate_hz = 200;
  int pitot_rate_hz = 50;
  int barometer_rate_hz = 50;
  int magnetometer_rate_hz = 50;
  int gps_rate_hz = 5;
  ImuConfig imu;
  PitotConfig pitot;
  BarometerConfig barometer;
  MagnetometerConfig magnetometer;
  GpsConfig gps;
};

template <typename Visitor>
void visit_fields(Visitor& visit, SensorsConfig& config) {
  visit("imu_rate_hz", config.imu_rate_hz, 1, 1200, "IMU samples per second; must divide 1200");
  visit("pitot_rate_hz", config.pitot_rate_hz, 1, 1200, "pitot tube samples per second; must divide 1200");
  visit("barometer_rate_hz", config.barometer_rate_hz, 1, 1200,
        "barometer samples per second; must divide 1200");
  visit("magnetometer_rate_hz", config.magnetometer_rate_hz, 1, 1200,
        "magnetometer samples per second; must divide 1200");
  visit("gps_rate_hz", config.gps_rate_hz, 1, 1200,
        "GPS fixes per second, if sensors.gps.enabled; must divide 1200");
  visit("imu", config.imu);
  visit("pitot", config.pitot);
  visit("barometer", config.barometer);
  visit("magnetometer", config.magnetometer);
  visit("gps", config.gps);
}

/// Quality of a scenario's sensors (`sensors.grade`); keys given beside it win. docs/sensors.md gives each
/// number and its source. GPS is off in every grade.
enum class SensorGrade {
  ideal,     ///< no errors at all; ranges, rates and delays stay
  nominal,   ///< white noise and constants only: the defaults of the structs
  consumer,  ///< every error of a part of this class, from data sheets and published measurements
  rough,     ///< every error three times the consumer grade's
};

SensorsConfig sensors_of_grade(SensorGrade grade);

enum class FaultySensor { imu, gyro, accelerometer, pitot, barometer, magnetometer, gps, camera };

enum class FaultKind {
  freeze,    ///< repeats its last reading (the camera its last pair) under new times
  dropout,   ///< nothing arrives; gyro and accelerometer share a sample, so without one neither arrives
  bias,      ///< adds `value`, to every axis; on a satellite fix to its position
  saturate,  ///< limits readings to +- `value` on every axis
  block,     ///< of the pitot: ice or an insect in the mouth, the drain open; reads `value`
};

inline constexpr std::array<std::pair<std::string_view, FaultySensor>, 8> faulty_sensor_names{
    {{"imu", FaultySensor::imu},
     {"gyro", FaultySensor::gyro},
     {"accelerometer", FaultySensor::accelerometer},
     {"pitot", FaultySensor::pitot},
     {"barometer", FaultySensor::barometer},
     {"magnetometer", FaultySensor::magnetometer},
     {"gps", FaultySensor::gps},
     {"camera", FaultySensor::camera}}};
inline constexpr std::array<std::pair<std::string_view, FaultKind>, 5> fault_kind_names{
    {{"freeze", FaultKind::freeze},
     {"dropout", FaultKind::dropout},
     {"bias", FaultKind::bias},
     {"saturate", FaultKind::saturate},
     {"block", FaultKind::block}}};

/// One entry of a scenario's `faults`: at_s <= t < at_s + duration_s, by the moment of measurement.
struct FaultConfig {
  FaultySensor sensor = FaultySensor::pitot;
  FaultKind kind = FaultKind::dropout;
  double at_s = 0;
  double duration_s = 1000;
  double value = 0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, FaultConfig& fault) {
  visit("sensor", fault.sensor, faulty_sensor_names, "sensor that fails");
  visit("kind", fault.kind, fault_kind_names, "kind of the failure | docs/sensors.md");
  visit("at_s", fault.at_s, 0.0, 1000.0,
        "simulated time at which the sensor fails; by default the catapult fires at 0.25 s");
  visit("duration_s", fault.duration_s, 0.0, 1000.0,
        "time for which the sensor fails; the default is longer than any flight");
  visit("value", fault.value, -10000.0, 10000.0,
        "bias: what is added to the reading; saturate: its limit; block: the reading; in the sensor's unit");
}

/// The kinds of fault that a sensor can have, as "freeze | dropout".
std::string_view fault_kinds_of(FaultySensor sensor);
bool can_have(FaultySensor sensor, FaultKind kind);

}  // namespace understory
