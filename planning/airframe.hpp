#pragma once

#include <Eigen/Core>

namespace understory {

class FieldVisitor;

/// The delta wing's numbers (TBS Caipirinha, 34 in), shared by the simulator's aerodynamics and the planner's
/// reduced model. Positions in the body frame x forward, y left, z up, at the centre of mass. Source of every
/// default: the original aircraft's identified flat-plate model (public flight records 2014 to 2017,
/// BSD-3-Clause), inertia the mean of measured and CAD values.
struct Airframe {
  double mass_kg = 0.648412;
  Eigen::Vector3d inertia_kgm2{0.01526, 0.00525, 0.01835};
  double gravity_mps2 = 9.81;
  double air_density_kgpm3 = 1.204;

  double span_m = 0.8636;
  double chord_m = 0.2097;
  double wing_area_m2 = 0.1811;
  double wing_lift_factor = 1.0;
  double wing_drag_factor = 1.0;

  double elevon_area_m2 = 0.012508;
  double elevon_hinge_x_m = -0.12495;
  double elevon_y_m = 0.276225;
  double elevon_chord_m = 0.0402;
  double elevon_lift_factor = 1.3;
  double elevon_drag_factor = 0.101;
  double elevon_min_rad = -0.90;
  double elevon_max_rad = 0.855;

  double winglet_area_m2 = 0.019441;
  double winglet_x_m = -0.08;
  double winglet_y_m = 0.4318;
  double winglet_z_m = 0.081954;

  double body_drag_area_m2 = 0.0443;
  Eigen::Vector3d rate_damping_nmspr{0.074, 0.115, 0.0};
  double max_thrust_n = 5.34;
  double input_delay_s = 0.020;
};

/// Every field by name, for loading, saving, --set and tuning: visit(name, field, minimum, maximum).
void visit_fields(FieldVisitor& visit, Airframe& airframe);

/// What the autopilot commands. Elevons: positive trailing edge UP (as in the flight records), so equal
/// positive deflections pitch the nose up, and left above right rolls to the left.
struct Controls {
  double left_elevon_rad = 0;
  double right_elevon_rad = 0;
  double thrust_n = 0;  ///< along body x, 0 .. the airframe's maximum
};

}  // namespace understory
