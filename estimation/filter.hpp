#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "estimation/filter_config.hpp"
#include "estimation/gate.hpp"
#include "estimation/history.hpp"
#include "estimation/measurements.hpp"
#include "estimation/propagation.hpp"
#include "estimation/state_source.hpp"

namespace understory {

/// The measurements that correct the filter in flight.
enum class Aid { airspeed, sideslip, angle_of_attack, altitude, heading, gps, resighting };
inline constexpr int aid_count = 7;

/// Error-state Kalman filter (order of State::covariance), driven by the IMU. On the catapult it finds roll
/// and pitch, estimates gyro bias and barometer offset, and keeps its position. It integrates the stroke from
/// rest. In flight it is corrected by pitot, lateral and normal specific force, barometer, magnetometer, GPS
/// and obstacles seen twice, each through a gate. Samples with a value that is not finite are ignored, and so
/// are IMU samples that are not newer than the last. Values beyond full scale are clamped. Long gaps are
/// integrated as DistrustConfig::longest_gap_s. Nothing here throws, and nothing allocates after the first
/// second. The error-state form and the angular_rate variant follow docs/sources.md [4] and [5].
class Filter : public StateSource {
 public:
  explicit Filter(const FilterConfig& config);

  void on(const Sample& sample) override {
    std::visit([this](const auto& one) { on(one); }, sample);
  }
  void on(const ImuSample& sample);
  void on(const PitotSample& sample);
  void on(const BarometerSample& sample);
  void on(const MagnetometerSample& sample);
  void on(const GpsSample& sample);
  void on(const ResightingSample& sample);
  void on(const ThrustSample& sample);
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override { return history_.at(t_ns); }

  bool launched() const { return launch_t_ns_.has_value(); }
  /// When the launch was detected (the second sample of the stroke); empty before.
  std::optional<std::int64_t> launch_t_ns() const { return launch_t_ns_; }
  /// Whether an aid is ignored because it has disagreed for too long.
  bool faulty(Aid aid) const { return gates_[static_cast<std::size_t>(aid)].faulty(); }
  /// Squared normalized innovation of an aid's newest measurement; nan before the first.
  double innovation_squared(Aid aid) const { return gates_[static_cast<std::size_t>(aid)].newest(); }
  /// IMU intervals longer than DistrustConfig::imu_gap_s.
  std::int64_t imu_gaps() const { return imu_gaps_; }

 private:
  void start(const ImuSample& sample);
  void propagate(const ImuSample& sample, double dt_s);
  void take_rates(const ImuSample& sample, double dt_s);
  void on_catapult(const ImuSample& sample, double dt_s);
  void settle(double dt_s);
  /// Corrects the attitude by gravity, and the gyro's bias. `mean`: of `samples` samples.
  void correct_at_rest(const ImuSample& mean, double dt_s, double samples);
  void in_flight(const ImuSample& sample);
  void launch(std::int64_t t_ns);
  ProcessNoise process_noise(const InertialStep& step) const;
  /// Corrects if the aid's gate admits the measurement.
  template <int M>
  bool fuse(Aid aid, const Measurement<M>& measurement, std::int64_t t_ns);
  /// Corrects with the mean innovation of FilterConfig::force_samples calls.
  void fuse_force(Aid aid, Measurement<1> measurement, std::int64_t t_ns);

  FilterConfig config_;
  State state_;
  History history_;
  ImuSample previous_;  ///< the newest IMU sample taken, clamped
  bool started_ = false;
  RestWindow rest_window_;
  bool at_rest_ = false;
  bool on_rail_ = false;  ///< launched, and the catapult still pushes
  std::optional<std::int64_t> launch_t_ns_;
  std::int64_t imu_gaps_ = 0;
  LaunchDetector launch_detector_;
  double resting_offset_m_ = 0;
  double thrust_n_ = 0;  ///< commanded
  AltitudeDrift altitude_drift_;
  std::vector<Gate> gates_;  ///< one for each Aid
  struct ForceSum {
    double innovation = 0;
    int samples = 0;
  };
  ForceSum lateral_force_, normal_force_;  ///< since the last correction
};

}  // namespace understory
