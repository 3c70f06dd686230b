#pragma once

#include "estimation/error_state.hpp"

namespace understory {

/// Angle of attack from normal specific force. The wing is a flat plate of area S. Its force is normal to it:
/// rho/2 V^2 S 2 sin(alpha), with V and sin(alpha) = -w/V of the air in the body's x-z plane. So the wing's
/// a_z = -rho S V w / m. The wing has no moment about the centre of mass. In steady flight the elevons' force
/// therefore balances the pitch damping: D q / (arm m) (docs/sources.md [3], identified model; trim checks
/// within 0.1 %).
struct AngleOfAttackConfig {
  /// Off: with the right wing it takes 0.01 m off the drift over 10 m, with one 20 % wrong in lift or mass it
  /// adds up to 0.2 m (docs/model_mismatch.md).
  bool enabled = false;
  double air_density_kgpm3 = 1.204;    ///< kg/m^3, 0.1..2
  double wing_area_m2 = 0.1811;        ///< m^2, 0.01..5
  double mass_kg = 0.648412;           ///< kg, 0.05..20
  double pitch_damping_nmspr = 0.115;  ///< N m s/rad, 0..10
  double elevon_arm_m = 0.145;         ///< m, 0.01..5: elevon force behind the centre of mass
  /// m/s^2, 0.01..100. Weak on purpose: a wrong wing is an error that 200 samples a second do not average
  /// out. Measured drift over 10 m in dodges (95 %): off 0.19 m, here 0.17 m, and 0.24 m with a wing 15 %
  /// wrong; with 1 m/s^2 the latter two are 0.13 m and 0.41 m.
  double sigma_mps2 = 6.0;
  double model_error = 0.15;  ///< fraction of the force, 0..1
};

template <typename Visitor>
void visit_fields(Visitor& visit, AngleOfAttackConfig& config) {
  visit("enabled", config.enabled);
  visit("air_density_kgpm3", config.air_density_kgpm3, 0.1, 2.0);
  visit("wing_area_m2", config.wing_area_m2, 0.01, 5.0);
  visit("mass_kg", config.mass_kg, 0.05, 20.0);
  visit("pitch_damping_nmspr", config.pitch_damping_nmspr, 0.0, 10.0);
  visit("elevon_arm_m", config.elevon_arm_m, 0.01, 5.0);
  visit("sigma_mps2", config.sigma_mps2, 0.01, 100.0);
  visit("model_error", config.model_error, 0.0, 1.0);
}

/// `normal_mps2` is the accelerometer's z. Precondition: the airspeed is not zero.
Measurement<1> angle_of_attack(const State& state, double normal_mps2, const AngleOfAttackConfig& config,
                               FilterModel model);

}  // namespace understory
