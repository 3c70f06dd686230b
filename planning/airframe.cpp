#include "planning/airframe.hpp"

#include "perception/field_visitor.hpp"

namespace understory {

void visit_fields(FieldVisitor& visit, Airframe& airframe) {
  visit("mass_kg", airframe.mass_kg, 0.05, 20.0, "mass of the whole aircraft");
  visit("inertia_kgm2", airframe.inertia_kgm2, 1e-5, 10.0, "principal moments of inertia about body x, y, z");
  visit("gravity_mps2", airframe.gravity_mps2, 1.0, 20.0, "acceleration of gravity");
  visit("air_density_kgpm3", airframe.air_density_kgpm3, 0.1, 2.0,
        "density of the air: sea level, 20 degrees C");
  visit("span_m", airframe.span_m, 0.1, 5.0,
        "distance between the wing tips; only the default has a body that collides");
  visit("chord_m", airframe.chord_m, 0.02, 2.0, "mean chord: wing area divided by span");
  visit("wing_area_m2", airframe.wing_area_m2, 0.01, 5.0, "area of the wing");
  visit("wing_lift_factor", airframe.wing_lift_factor, 0.1, 10.0,
        "ratio of the wing's lift to that of a flat plate");
  visit("wing_drag_factor", airframe.wing_drag_factor, 0.0, 10.0,
        "ratio of the wing's drag to that of a flat plate");
  visit("elevon_area_m2", airframe.elevon_area_m2, 1e-4, 1.0, "area of one elevon");
  visit("elevon_hinge_x_m", airframe.elevon_hinge_x_m, -2.0, 2.0,
        "x of the elevons' hinge; negative: behind the centre of mass");
  visit("elevon_y_m", airframe.elevon_y_m, 0.0, 5.0,
        "y of the left elevon's centre; the right elevon mirrors it");
  visit("elevon_chord_m", airframe.elevon_chord_m, 0.001, 1.0,
        "chord of an elevon; its force acts at mid-chord of the deflected surface");
  visit("elevon_lift_factor", airframe.elevon_lift_factor, 0.0, 10.0,
        "ratio of an elevon's lift to that of a flat plate");
  visit("elevon_drag_factor", airframe.elevon_drag_factor, 0.0, 10.0,
        "ratio of an elevon's drag to that of a flat plate");
  visit("elevon_min_rad", airframe.elevon_min_rad, -1.57, 0.0,
        "smallest elevon deflection; trailing edge up is positive");
  visit("elevon_max_rad", airframe.elevon_max_rad, 0.0, 1.57,
        "largest elevon deflection; trailing edge up is positive");
  visit("winglet_area_m2", airframe.winglet_area_m2, 0.0, 1.0, "area of one winglet");
  visit("winglet_x_m", airframe.winglet_x_m, -2.0, 2.0,
        "x of the winglets' centres; negative: behind the centre of mass");
  visit("winglet_y_m", airframe.winglet_y_m, 0.0, 5.0, "y of the left winglet; the right winglet mirrors it");
  visit("winglet_z_m", airframe.winglet_z_m, -1.0, 1.0,
        "height of a winglet's centre above the centre of mass");
  visit("body_drag_area_m2", airframe.body_drag_area_m2, 0.0, 1.0,
        "drag of the body along x, divided by the dynamic pressure");
  visit("rate_damping_nmspr", airframe.rate_damping_nmspr, 0.0, 10.0,
        "damping moment per unit of angular rate, about body x, y, z");
  visit("max_thrust_n", airframe.max_thrust_n, 0.0, 200.0, "thrust at full throttle");
  visit("input_delay_s", airframe.input_delay_s, 0.0, 0.5,
        "time from an autopilot command until the actuators receive it");
}

}  // namespace understory
