#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace understory {

class FieldVisitor;

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

/// Rates must divide 1200 Hz (checked when a scenario is loaded).
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

void visit_fields(FieldVisitor& visit, SensorsConfig& config);

/// Quality of a scenario's sensors (`sensors.grade`); keys given beside it have priority. docs/sensors.md
/// gives each number and its source. GPS is off in every grade.
enum class SensorGrade {
  ideal,     ///< no errors at all; ranges, rates and delays stay
  nominal,   ///< white noise and constants only: the defaults of the structs
  consumer,  ///< every error of a part of this class, from data sheets and published measurements
  rough,     ///< every error three times the consumer grade's
};

SensorsConfig sensors_of_grade(SensorGrade grade);

/// What fails: a sensor, the elevons, or the autopilot's map.
enum class FaultySensor {
  imu,
  gyro,
  accelerometer,
  pitot,
  barometer,
  magnetometer,
  gps,
  camera,
  elevons,
  map
};

enum class FaultKind {
  freeze,    ///< repeats its last reading (the camera its last pair) under new times
  dropout,   ///< nothing arrives; gyro and accelerometer share a sample, so without one neither arrives
  bias,      ///< adds `value`, to every axis; on a satellite fix to its position
  saturate,  ///< limits readings to +- `value` on every axis
  block,     ///< of the pitot: ice or an insect in the mouth, the drain open; reads `value`
  cover,     ///< of the camera: the right part of both images is black, a share of `value`; below 0: the left
  delay,     ///< of the camera: frames arrive `value` seconds later
  weaken,    ///< of the elevons: they deflect by `value` of what is commanded
};

inline constexpr std::array<std::pair<std::string_view, FaultySensor>, 10> faulty_sensor_names{
    {{"imu", FaultySensor::imu},
     {"gyro", FaultySensor::gyro},
     {"accelerometer", FaultySensor::accelerometer},
     {"pitot", FaultySensor::pitot},
     {"barometer", FaultySensor::barometer},
     {"magnetometer", FaultySensor::magnetometer},
     {"gps", FaultySensor::gps},
     {"camera", FaultySensor::camera},
     {"elevons", FaultySensor::elevons},
     {"map", FaultySensor::map}}};
inline constexpr std::array<std::pair<std::string_view, FaultKind>, 8> fault_kind_names{
    {{"freeze", FaultKind::freeze},
     {"dropout", FaultKind::dropout},
     {"bias", FaultKind::bias},
     {"saturate", FaultKind::saturate},
     {"block", FaultKind::block},
     {"cover", FaultKind::cover},
     {"delay", FaultKind::delay},
     {"weaken", FaultKind::weaken}}};

/// One entry of a scenario's `faults`: at_s <= t < at_s + duration_s, by the moment of measurement.
struct FaultConfig {
  FaultySensor sensor = FaultySensor::pitot;
  FaultKind kind = FaultKind::dropout;
  double at_s = 0;
  double duration_s = 1000;
  double value = 0;
};

void visit_fields(FieldVisitor& visit, FaultConfig& fault);

/// The kinds of fault that a sensor can have, as "freeze | dropout".
std::string_view fault_kinds_of(FaultySensor sensor);
bool can_have(FaultySensor sensor, FaultKind kind);

}  // namespace understory
