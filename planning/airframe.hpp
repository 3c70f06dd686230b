#pragma once

#include <Eigen/Core>

namespace understory {

/// The delta wing's numbers (TBS Caipirinha, 34 in), shared by the simulator's aerodynamics and the planner's
/// reduced model. Positions in the body frame x forward, y left, z up, at the centre of mass. Source of every
/// default: the original aircraft's identified flat-plate model (public flight records 2014 to 2017,
/// BSD-3-Clause), inertia the mean of measured and CAD values.
struct Airframe {
  double mass_kg = 0.648412;  ///< mass of the whole aircraft
  Eigen::Vector3d inertia_kgm2{0.01526, 0.00525,
                               0.01835};  ///< principal moments of inertia about body x, y, z
  double gravity_mps2 = 9.81;             ///< acceleration of gravity
  double air_density_kgpm3 = 1.204;       ///< density of the air: sea level, 20 degrees C

  double span_m = 0.8636;         ///< distance between the wing tips
  double chord_m = 0.2097;        ///< mean chord: wing area divided by span
  double wing_area_m2 = 0.1811;   ///< area of the wing
  double wing_lift_factor = 1.0;  ///< ratio of the wing's lift to that of a flat plate
  double wing_drag_factor = 1.0;  ///< ratio of the wing's drag to that of a flat plate

  double elevon_area_m2 = 0.012508;    ///< area of one elevon
  double elevon_hinge_x_m = -0.12495;  ///< x of the elevons' hinge; negative: behind the centre of mass
  double elevon_y_m = 0.276225;        ///< y of the left elevon's centre; the right elevon mirrors it
  /// chord of an elevon; its force acts at mid-chord of the deflected surface
  double elevon_chord_m = 0.0402;
  double elevon_lift_factor = 1.3;    ///< ratio of an elevon's lift to that of a flat plate
  double elevon_drag_factor = 0.101;  ///< ratio of an elevon's drag to that of a flat plate
  double elevon_min_rad = -0.90;      ///< smallest elevon deflection; trailing edge up is positive
  double elevon_max_rad = 0.855;      ///< largest elevon deflection; trailing edge up is positive

  double winglet_area_m2 = 0.019441;  ///< area of one winglet
  double winglet_x_m = -0.08;         ///< x of the winglets' centres; negative: behind the centre of mass
  double winglet_y_m = 0.4318;        ///< y of the left winglet; the right winglet mirrors it
  double winglet_z_m = 0.081954;      ///< height of a winglet's centre above the centre of mass

  double body_drag_area_m2 = 0.0443;  ///< drag of the body along x, divided by the dynamic pressure
  /// damping moment per unit of angular rate, about body x, y, z
  Eigen::Vector3d rate_damping_nmspr{0.074, 0.115, 0.0};
  double max_thrust_n = 5.34;    ///< thrust at full throttle
  double input_delay_s = 0.020;  ///< time from an autopilot command until the actuators receive it
};

/// Every field by name, for loading, saving, --set and tuning: visit(name, field, minimum, maximum).
template <typename Visitor>
void visit_fields(Visitor& visit, Airframe& airframe) {
  visit("mass_kg", airframe.mass_kg, 0.05, 20.0);
  visit("inertia_kgm2", airframe.inertia_kgm2, 1e-5, 10.0);
  visit("gravity_mps2", airframe.gravity_mps2, 1.0, 20.0);
  visit("air_density_kgpm3", airframe.air_density_kgpm3, 0.1, 2.0);
  visit("span_m", airframe.span_m, 0.1, 5.0);
  visit("chord_m", airframe.chord_m, 0.02, 2.0);
  visit("wing_area_m2", airframe.wing_area_m2, 0.01, 5.0);
  visit("wing_lift_factor", airframe.wing_lift_factor, 0.1, 10.0);
  visit("wing_drag_factor", airframe.wing_drag_factor, 0.0, 10.0);
  visit("elevon_area_m2", airframe.elevon_area_m2, 1e-4, 1.0);
  visit("elevon_hinge_x_m", airframe.elevon_hinge_x_m, -2.0, 2.0);
  visit("elevon_y_m", airframe.elevon_y_m, 0.0, 5.0);
  visit("elevon_chord_m", airframe.elevon_chord_m, 0.001, 1.0);
  visit("elevon_lift_factor", airframe.elevon_lift_factor, 0.0, 10.0);
  visit("elevon_drag_factor", airframe.elevon_drag_factor, 0.0, 10.0);
  visit("elevon_min_rad", airframe.elevon_min_rad, -1.57, 0.0);
  visit("elevon_max_rad", airframe.elevon_max_rad, 0.0, 1.57);
  visit("winglet_area_m2", airframe.winglet_area_m2, 0.0, 1.0);
  visit("winglet_x_m", airframe.winglet_x_m, -2.0, 2.0);
  visit("winglet_y_m", airframe.winglet_y_m, 0.0, 5.0);
  visit("winglet_z_m", airframe.winglet_z_m, -1.0, 1.0);
  visit("body_drag_area_m2", airframe.body_drag_area_m2, 0.0, 1.0);
  visit("rate_damping_nmspr", airframe.rate_damping_nmspr, 0.0, 10.0);
  visit("max_thrust_n", airframe.max_thrust_n, 0.0, 200.0);
  visit("input_delay_s", airframe.input_delay_s, 0.0, 0.5);
}

/// What the autopilot commands. Elevons: positive trailing edge UP (as in the flight records), so equal
/// positive deflections pitch the nose up, and left above right rolls to the left.
struct Controls {
  double left_elevon_rad = 0;
  double right_elevon_rad = 0;
  double thrust_n = 0;  ///< along body x, 0 .. the airframe's maximum
};

}  // namespace understory
