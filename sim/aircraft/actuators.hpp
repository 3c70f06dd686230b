#pragma once

#include "planning/controls.hpp"

namespace understory {

/// Dynamics between a command and its effect on the air. The identified model has none (its airframe answers
/// one input delay later, at once and in full), so every part is off by default, at 0. The flight record
/// cannot separate delay from lag (docs/flight_model.md), so the values in the comments are typical and none
/// is fitted.
struct ActuatorsConfig {
  double elevon_time_s = 0;      ///< first-order lag of the servos; 0.030 in docs/sources.md [14]
  double elevon_rate_radps = 0;  ///< maximum; 8.7 is 0.12 s per 60 deg, from data sheets of 9 g servos
  double motor_time_s = 0;       ///< first-order lag of the thrust; about 0.05 with a 7 in propeller
  /// Airspeed at which the propeller's thrust is zero: pitch times revolutions, 5 in at 10,000 rpm is 21 m/s.
  /// Thrust falls linearly up to it (nearly true of measured propellers: Brandt & Selig 2011, "Propeller
  /// Performance Data at Low Reynolds Numbers").
  double pitch_speed_mps = 0;
  /// Airspeed at which the thrust equals the command: the identified model's trim. Below it the thrust is
  /// larger.
  double thrust_speed_mps = 12.27;
  /// Share of the slipstream's speed at the elevons; 1 if they are in it. The disc (radius 0.09 m) is behind
  /// and inboard of the elevons (from 0.13 m out), so 0.1 is a guess.
  double propwash_share = 0;
  double propeller_diameter_m = 0.18;  ///< 7 in, as drawn in models/airframe
  /// Motor torque per thrust, D C_P / (2 pi C_T): 0.014 m with C_P / C_T = 0.5 (Brandt & Selig 2011).
  /// Positive: the propeller turns clockwise seen from behind and rolls the aircraft to the left.
  double torque_per_thrust_m = 0;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ActuatorsConfig& config) {
  visit("elevon_time_s", config.elevon_time_s, 0.0, 1.0);
  visit("elevon_rate_radps", config.elevon_rate_radps, 0.0, 100.0);
  visit("motor_time_s", config.motor_time_s, 0.0, 2.0);
  visit("pitch_speed_mps", config.pitch_speed_mps, 0.0, 100.0);
  visit("thrust_speed_mps", config.thrust_speed_mps, 0.0, 50.0);
  visit("propwash_share", config.propwash_share, 0.0, 1.0);
  visit("propeller_diameter_m", config.propeller_diameter_m, 0.02, 1.0);
  visit("torque_per_thrust_m", config.torque_per_thrust_m, -0.1, 0.1);
}

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
