#include "sim/sensors/sensors_config.hpp"

#include <cmath>

namespace understory {
namespace {

constexpr double degree = M_PI / 180;
constexpr double standard_gravity_mps2 = 9.80665;
constexpr double imu_rate_hz = 200;

/// MPU-6000: noise densities and tolerances from its product specification, PS-MPU-6000A-00 revision 3.4;
/// floor of the Allan deviation and the averaging time at which it lies from Greenheck (Marquette University,
/// 2015, section 2.2, as quoted in AirSim's ImuSimpleParams.hpp): gyro 4.6 deg/h at 500 s, accelerometer 36
/// ug at 800 s. The random walk places the minimum there: N^2/t = K^2 t/3, so K = sqrt(3) N / t.
ImuConfig mpu_6000() {
  ImuConfig imu;
  const double gyro_density = 0.005 * degree;                           // rad/s/sqrt(Hz)
  const double accelerometer_density = 400e-6 * standard_gravity_mps2;  // m/s^2/sqrt(Hz)
  imu.gyro_noise_radps = gyro_density * std::sqrt(imu_rate_hz);
  imu.gyro_bias_instability_radps = 4.6 / 3600 * degree;
  imu.gyro_walk_radpsps_rthz = std::sqrt(3.0) * gyro_density / 500;
  imu.gyro_scale = 0.01;              // tolerance 3 %, taken as three sigma
  imu.gyro_misalignment = 0.0067;     // cross-axis sensitivity 2 %, likewise
  imu.gyro_vibration_radpspn = 0.02;  // typical
  imu.accelerometer_noise_mps2 = accelerometer_density * std::sqrt(imu_rate_hz);
  imu.accelerometer_bias_instability_mps2 = 36e-6 * standard_gravity_mps2;
  imu.accelerometer_walk_mps2ps_rthz = std::sqrt(3.0) * accelerometer_density / 800;
  imu.accelerometer_scale = 0.01;
  imu.accelerometer_misalignment = 0.0067;
  // Not from a data sheet, typical of a soft mount: about 1.5 m/s^2 in cruise, 5 at full thrust.
  imu.accelerometer_vibration_mps2pn = 1.0;
  return imu;
}

SensorsConfig consumer() {
  SensorsConfig sensors;
  sensors.imu = mpu_6000();
  sensors.pitot.dead_zone_pa = 4;  // 2.6 m/s; this and the rest typical
  sensors.pitot.recovery_loss = 2;
  sensors.barometer.wash_m_per_n = 0.13;  // 0.2 m before the propeller
  sensors.magnetometer.soft_iron = 0.01;
  return sensors;
}

/// Multiplies every error by `factor`. Ranges, resolutions, rates, delays and time constants stay.
SensorsConfig worse(SensorsConfig sensors, double factor) {
  ImuConfig& imu = sensors.imu;
  PitotConfig& pitot = sensors.pitot;
  BarometerConfig& barometer = sensors.barometer;
  MagnetometerConfig& magnetometer = sensors.magnetometer;
  GpsConfig& gps = sensors.gps;
  const auto scale = [factor](auto&... errors) { ((errors *= factor), ...); };
  scale(imu.gyro_noise_radps, imu.gyro_bias_radps, imu.gyro_bias_instability_radps,
        imu.gyro_walk_radpsps_rthz, imu.gyro_scale, imu.gyro_misalignment, imu.gyro_vibration_radpspn,
        imu.accelerometer_noise_mps2, imu.accelerometer_bias_mps2, imu.accelerometer_bias_instability_mps2,
        imu.accelerometer_walk_mps2ps_rthz, imu.accelerometer_scale, imu.accelerometer_misalignment,
        imu.accelerometer_vibration_mps2pn);
  scale(pitot.pressure_noise_pa, pitot.pressure_bias_pa, pitot.dead_zone_pa, pitot.recovery_loss);
  scale(barometer.noise_m, barometer.drift_m, barometer.wash_m_per_n);
  scale(magnetometer.noise_ut, magnetometer.hard_iron_ut, magnetometer.soft_iron);
  scale(gps.velocity_noise_mps, gps.position_noise_m, gps.position_drift_m);
  return sensors;
}

SensorsConfig ideal() {
  SensorsConfig sensors = worse({}, 0);
  sensors.imu.gyro_step_radps = sensors.imu.accelerometer_step_mps2 = 0;
  sensors.pitot.pressure_step_pa = 0;
  sensors.barometer.step_m = 0;
  sensors.magnetometer.step_ut = 0;
  return sensors;
}

}  // namespace

SensorsConfig sensors_of_grade(SensorGrade grade) {
  switch (grade) {
    case SensorGrade::ideal:
      return ideal();
    case SensorGrade::nominal:
      break;
    case SensorGrade::consumer:
      return consumer();
    case SensorGrade::rough:
      return worse(consumer(), 3);
  }
  return {};
}

std::string_view fault_kinds_of(FaultySensor sensor) {
  switch (sensor) {
    case FaultySensor::imu:
    case FaultySensor::camera:
      return "freeze | dropout";
    case FaultySensor::gps:
      return "freeze | dropout | bias";
    case FaultySensor::pitot:
      return "freeze | dropout | bias | saturate | block";
    default:
      return "freeze | dropout | bias | saturate";
  }
}

bool can_have(FaultySensor sensor, FaultKind kind) {
  const std::string_view word = fault_kind_names[static_cast<std::size_t>(kind)].first;
  return fault_kinds_of(sensor).find(word) != std::string_view::npos;
}

}  // namespace understory
