#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "estimation/samples.hpp"
#include "perception/stereo_frame.hpp"

namespace understory {

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
  double at_s = 0;           ///< of simulated time, which begins 0.25 s of rest before the catapult fires
  double duration_s = 1000;  ///< beyond any flight by default
  double value = 0;          ///< in the sensor's unit (rad/s, m/s^2, m/s, m, uT); see FaultKind
};

template <typename Visitor>
void visit_fields(Visitor& visit, FaultConfig& fault) {
  visit("sensor", fault.sensor, faulty_sensor_names);
  visit("kind", fault.kind, fault_kind_names);
  visit("at_s", fault.at_s, 0.0, 1000.0);
  visit("duration_s", fault.duration_s, 0.0, 1000.0);
  visit("value", fault.value, -10000.0, 10000.0);
}

/// The kinds of fault that a sensor can have, as "freeze | dropout".
std::string_view fault_kinds_of(FaultySensor sensor);
bool can_have(FaultySensor sensor, FaultKind kind);

/// Stands between sensors and autopilot and applies the scheduled faults to samples. It does not know the
/// truth.
class Faults {
 public:
  explicit Faults(std::vector<FaultConfig> schedule) : schedule_(std::move(schedule)) {}

  /// Applies the faults of the sample's time. False: the sample is lost. To be called in order of time for
  /// each sensor.
  bool pass(ImuSample& sample);
  bool pass(PitotSample& sample);
  bool pass(BarometerSample& sample);
  bool pass(MagnetometerSample& sample);
  bool pass(GpsSample& sample);
  bool pass(StereoFrame& frame);

 private:
  /// A sensor's last reading before it froze.
  struct LastReadings {
    std::optional<Eigen::Vector3d> angular_rate_body_radps, specific_force_body_mps2, field_body_ut;
    std::optional<double> airspeed_mps, altitude_m;
    std::optional<GpsSample> fix;
    std::optional<StereoFrame> frame;
  };

  bool has(FaultySensor sensor, FaultKind kind, std::int64_t t_ns) const;
  template <typename Reading>
  Reading altered(FaultySensor sensor, std::int64_t t_ns, Reading reading) const;
  template <typename Reading>
  Reading held(bool frozen, Reading reading, std::optional<Reading>& last) const;

  std::vector<FaultConfig> schedule_;
  LastReadings last_;
};

}  // namespace understory
