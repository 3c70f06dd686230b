#include "sim/aircraft/aircraft_config.hpp"

namespace understory {

Airframe mismatched(Airframe airframe, const MismatchConfig& mismatch) {
  const auto factor = [](double percent) { return 1 + percent / 100; };  // exactly 1 at 0
  airframe.mass_kg *= factor(mismatch.mass_percent);
  airframe.inertia_kgm2 *= factor(mismatch.mass_percent);
  airframe.wing_lift_factor *= factor(mismatch.lift_percent);
  airframe.elevon_lift_factor *= factor(mismatch.lift_percent);
  airframe.wing_drag_factor *= factor(mismatch.drag_percent);
  airframe.elevon_drag_factor *= factor(mismatch.drag_percent);
  airframe.body_drag_area_m2 *= factor(mismatch.drag_percent);
  airframe.rate_damping_nmspr *= factor(mismatch.damping_percent);
  airframe.input_delay_s *= factor(mismatch.delay_percent);
  return airframe;
}

}  // namespace understory
