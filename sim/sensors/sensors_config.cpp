#include "sim/sensors/sensors_config.hpp"

#include "perception/field_visitor.hpp"

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
      return "freeze | dropout";
    case FaultySensor::camera:
      return "freeze | dropout | cover | delay";
    case FaultySensor::elevons:
      return "weaken";
    case FaultySensor::map:
      return "dropout";
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

void visit_fields(FieldVisitor& visit, ImuConfig& config) {
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

void visit_fields(FieldVisitor& visit, PitotConfig& config) {
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

void visit_fields(FieldVisitor& visit, BarometerConfig& config) {
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

void visit_fields(FieldVisitor& visit, MagnetometerConfig& config) {
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

void visit_fields(FieldVisitor& visit, GpsConfig& config) {
  visit("enabled", config.enabled,
        "Whether the aircraft has a GPS receiver; the original aircraft avoided obstacles without one. "
        "Default on a course of over 100 m: true.");
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

void visit_fields(FieldVisitor& visit, SensorsConfig& config) {
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

void visit_fields(FieldVisitor& visit, FaultConfig& fault) {
  visit("sensor", fault.sensor, faulty_sensor_names,
        "what fails: a sensor, the elevons, or the map, whose points are then forgotten at once");
  visit("kind", fault.kind, fault_kind_names, "kind of the failure | docs/sensors.md");
  visit("at_s", fault.at_s, 0.0, 1000.0,
        "simulated time at which the sensor fails; by default the catapult fires at 0.25 s");
  visit("duration_s", fault.duration_s, 0.0, 1000.0,
        "time for which the sensor fails; the default is longer than any flight");
  visit("value", fault.value, -10000.0, 10000.0,
        "bias: what is added to the reading; saturate: its limit; block: the reading; in the sensor's unit. "
        "cover: the share of the images that is black, on the right, below 0 on the left; delay: how much "
        "later frames arrive, s, at most 0.3; weaken: the share of a command that the elevons follow.");
}

}  // namespace understory
