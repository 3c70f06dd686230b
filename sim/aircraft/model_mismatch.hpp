#pragma once

#include "planning/airframe.hpp"

namespace understory {

/// Difference between the aircraft that flies and the airframe that the stack believes in, in percent of the
/// stack's value: 10 is a tenth more, 0 the same.
struct MismatchConfig {
  double mass_percent = 0;     ///< mass_kg, and inertia_kgm2 with it: the same aircraft, denser
  double lift_percent = 0;     ///< wing_lift_factor and elevon_lift_factor
  double drag_percent = 0;     ///< wing_drag_factor, elevon_drag_factor and body_drag_area_m2
  double damping_percent = 0;  ///< rate_damping_nmspr
  double delay_percent = 0;    ///< input_delay_s (taken to whole physics steps, 0.83 ms)
};

template <typename Visitor>
void visit_fields(Visitor& visit, MismatchConfig& config) {
  visit("mass_percent", config.mass_percent, -50.0, 100.0);
  visit("lift_percent", config.lift_percent, -50.0, 100.0);
  visit("drag_percent", config.drag_percent, -90.0, 400.0);
  visit("damping_percent", config.damping_percent, -90.0, 400.0);
  visit("delay_percent", config.delay_percent, -100.0, 400.0);
}

/// The airframe that flies.
Airframe mismatched(Airframe airframe, const MismatchConfig& mismatch);

}  // namespace understory
