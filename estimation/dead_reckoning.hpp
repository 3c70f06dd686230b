#pragma once

#include <optional>

#include "estimation/filter_config.hpp"
#include "estimation/history.hpp"
#include "estimation/measurements.hpp"
#include "estimation/state_source.hpp"

namespace understory {

class FieldVisitor;

struct DeadReckoningConfig {
  double angle_of_attack_rad = 0.19;
};

void visit_fields(FieldVisitor& visit, DeadReckoningConfig& config);

/// The state from pitot and gyro alone, without a filter: the turn rates integrated from the known attitude
/// on the catapult, the airspeed integrated along an assumed angle of attack. The gyro's bias is its mean at
/// rest. Without wind, sideslip or any correction, so all errors grow; the covariance stays zero.
class DeadReckoning : public StateSource {
 public:
  /// Uses only the start and the launch threshold of the filter's configuration.
  DeadReckoning(const DeadReckoningConfig& config, const FilterConfig& filter);

  void on(const Sample& sample) override;
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override { return history_.at(t_ns); }

 private:
  void on_imu(const ImuSample& sample);

  DeadReckoningConfig config_;
  State state_;
  History history_;
  LaunchDetector launch_detector_;
  bool launched_ = false;
  std::optional<std::int64_t> previous_ns_;  ///< of the newest IMU sample
  double airspeed_mps_ = 0;                  ///< along body x
  std::int64_t resting_samples_ = 0;
};

}  // namespace understory
