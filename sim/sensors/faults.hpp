#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "estimation/samples.hpp"
#include "perception/stereo_frame.hpp"
#include "sim/sensors/sensors_config.hpp"

namespace understory {

/// The columns of an image that a camera's cover leaves free: from the first, to the one behind the last.
std::pair<int, int> free_columns(double cover, int width_px);

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

  bool has(FaultySensor sensor, FaultKind kind, std::int64_t t_ns) const {
    return value(sensor, kind, t_ns).has_value();
  }
  /// The fault's value; nothing where it is not in force.
  std::optional<double> value(FaultySensor sensor, FaultKind kind, std::int64_t t_ns) const;

 private:
  /// A sensor's last reading before it froze.
  struct LastReadings {
    std::optional<Eigen::Vector3d> angular_rate_body_radps, specific_force_body_mps2, field_body_ut;
    std::optional<double> airspeed_mps, altitude_m;
    std::optional<GpsSample> fix;
    std::optional<StereoFrame> frame;
  };

  template <typename Reading>
  Reading altered(FaultySensor sensor, std::int64_t t_ns, Reading reading) const;
  template <typename Reading>
  Reading held(bool frozen, Reading reading, std::optional<Reading>& last) const;

  std::vector<FaultConfig> schedule_;
  LastReadings last_;
};

}  // namespace understory
