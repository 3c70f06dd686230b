#pragma once

#include "planning/airframe.hpp"
#include "sim/aircraft/aircraft_config.hpp"

namespace understory {

/// Elevon servos and motor: commands in (already delayed and within limits), positions and thrust out.
class Actuators {
 public:
  explicit Actuators(const ActuatorsConfig& config) : config_(config) {}

  void settle(const Controls& controls) { now_ = controls; }  ///< the state after holding `controls` for long
  void advance(const Controls& commanded, double step_s);

  /// Positions of the surfaces and the thrust.
  double left_elevon_rad() const { return now_.left_elevon_rad; }
  double right_elevon_rad() const { return now_.right_elevon_rad; }
  /// Thrust at this airspeed along body x. Never below zero: above its pitch speed the propeller does not
  /// brake.
  double thrust_n(double forward_airspeed_mps) const;
  /// Speed that the propeller adds to the air along body x at the elevons (momentum theory, far wake).
  double elevon_wash_mps(double forward_airspeed_mps, double air_density_kgpm3) const;
  double motor_torque_nm(double forward_airspeed_mps) const;

 private:
  ActuatorsConfig config_;
  Controls now_;
};

}  // namespace understory
