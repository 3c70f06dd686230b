#pragma once

#include <cstdint>
#include <optional>

#include "estimation/filter_config.hpp"
#include "estimation/gate.hpp"
#include "estimation/history.hpp"
#include "estimation/propagation.hpp"
#include "estimation/state_source.hpp"

namespace understory {

/// Error-state Kalman filter with 12 error states (order of State::covariance), driven by the IMU. On the
/// catapult it levels itself, learns the gyro bias and the barometer's offset and holds its place; the stroke
/// is integrated from rest; in flight pitot, lateral and normal specific force, barometer and magnetometer
/// correct it through gates. Samples with a value that is not finite are ignored, values beyond full scale
/// clamped, IMU samples that are not newer than the last ignored, long gaps integrated as
/// FilterConfig::max_gap_s. Nothing here throws. The error-state form and the angular_rate variant follow
/// Bry, Bachrach and Roy 2012 and Sola 2017 (arXiv 1711.02508).
class Filter : public StateSource {
 public:
  explicit Filter(const FilterConfig& config);

  void on(const ImuSample& sample) override;
  void on(const PitotSample& sample) override;
  void on(const BarometerSample& sample) override;
  void on(const MagnetometerSample& sample) override;
  void on(const GpsSample&) override {}
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override { return history_.at(t_ns); }

  bool launched() const { return launch_t_ns_.has_value(); }
  /// When the launch was detected (the second sample of the stroke); empty before.
  std::optional<std::int64_t> launch_t_ns() const { return launch_t_ns_; }

 private:
  void start(const ImuSample& sample);
  void propagate(const ImuSample& sample, double dt_s);
  void take_rates(const ImuSample& sample, double dt_s);
  void on_catapult(const ImuSample& sample, double dt_s);
  void in_flight(const ImuSample& sample);
  void launch(std::int64_t t_ns);
  /// Corrects where the gate admits, then records the outcome as the newest moment of the history.
  void fuse(const Measurement<1>& measurement, Gate& gate, PositionGain position, std::int64_t t_ns);

  FilterConfig config_;
  State state_;
  History history_;
  ImuSample previous_;  ///< the newest IMU sample taken, clamped
  bool started_ = false;
  bool at_rest_ = false;
  std::optional<std::int64_t> launch_t_ns_;
  LaunchDetector launch_detector_;
  BarometerOffset barometer_offset_;
  Gate airspeed_gate_, sideslip_gate_, angle_of_attack_gate_, altitude_gate_, heading_gate_;
};

}  // namespace understory
