#include "sim/aircraft/aircraft_config.hpp"

#include "perception/field_visitor.hpp"

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

void visit_fields(FieldVisitor& visit, LaunchConfig& config) {
  visit("speed_mps", config.speed_mps, 5.0, 20.0, "speed along the catapult at release (our assumption)");
  visit("altitude_m", config.altitude_m, 0.3, 10.0, "height of the release point");
  visit("climb_angle_rad", config.climb_angle_rad, -0.2, 0.6, "slope of the catapult's rail");
  visit("rail_length_m", config.rail_length_m, 0.2, 10.0,
        "length of the rail; to reach 12 m/s on 1.5 m takes 48 m/s^2");
  visit("rest_s", config.rest_s, 0.0, 5.0, "time at rest on the rail before the catapult fires");
}

void visit_fields(FieldVisitor& visit, ActuatorsConfig& config) {
  visit("elevon_time_s", config.elevon_time_s, 0.0, 1.0,
        "time constant of the elevon servos' lag; 0: no lag; 0.030 in docs/sources.md [14] | docs/sources.md "
        "[14]");
  visit("elevon_rate_radps", config.elevon_rate_radps, 0.0, 100.0,
        "maximum rate of the elevon servos; 0: no limit; 8.7 rad/s is 0.12 s per 60 deg");
  visit("motor_time_s", config.motor_time_s, 0.0, 2.0,
        "time constant of the thrust's lag; 0: no lag; about 0.05 with a 7 inch propeller");
  visit("pitch_speed_mps", config.pitch_speed_mps, 0.0, 100.0,
        "Airspeed at which the propeller's thrust reaches zero: pitch times revolutions, 21 m/s for 5 in at "
        "10,000 rpm. Thrust falls linearly with airspeed (nearly true of measured propellers: Brandt & Selig "
        "2011, \"Propeller Performance Data at Low Reynolds Numbers\"). 0: thrust does not depend on "
        "airspeed. | Brandt & Selig 2011");
  visit("thrust_speed_mps", config.thrust_speed_mps, 0.0, 50.0,
        "Airspeed at which the thrust equals the command: the identified model's trim. At lower airspeed the "
        "thrust is larger. Unused if pitch_speed_mps is 0.");
  visit("propwash_share", config.propwash_share, 0.0, 1.0,
        "Share of the slipstream's extra speed that the elevons meet. The propeller disc (radius 0.09 m) is "
        "behind and inboard of the elevons (from 0.13 m out), so a value like 0.1 is a guess.");
  visit("propeller_diameter_m", config.propeller_diameter_m, 0.02, 1.0,
        "diameter of the propeller: 7 in, as drawn in models/airframe");
  visit("torque_per_thrust_m", config.torque_per_thrust_m, -0.1, 0.1,
        "Motor torque per newton of thrust, D C_P / (2 pi C_T): 0.014 m with C_P / C_T = 0.5. Positive: the "
        "propeller turns clockwise seen from behind, and the reaction rolls the aircraft to the left. | "
        "Brandt & Selig 2011");
}

void visit_fields(FieldVisitor& visit, MismatchConfig& config) {
  visit("mass_percent", config.mass_percent, -50.0, 100.0,
        "change of the flown aircraft's mass and inertia from airframe.mass_kg and airframe.inertia_kgm2");
  visit("lift_percent", config.lift_percent, -50.0, 100.0,
        "change of the flown aircraft's lift factors from airframe.wing_lift_factor and .elevon_lift_factor");
  visit("drag_percent", config.drag_percent, -90.0, 400.0,
        "change of the flown aircraft's wing, elevon and body drag from that of the airframe keys");
  visit("damping_percent", config.damping_percent, -90.0, 400.0,
        "change of the flown aircraft's damping from airframe.rate_damping_nmspr");
  visit("delay_percent", config.delay_percent, -100.0, 400.0,
        "change of the flown aircraft's delay from airframe.input_delay_s; rounded to physics steps of 0.83 "
        "ms");
}

void visit_fields(FieldVisitor& visit, GustConfig& config) {
  visit("start_s", config.start_s, 0.0, 600.0,
        "simulated time at which the gust begins; by default the catapult releases the aircraft at 0.5 s");
  visit("length_m", config.length_m, 0.1, 1000.0,
        "distance flown while the gust grows to full velocity (MIL-F-8785C: tuned to the mode to be excited) "
        "| MIL-F-8785C");
  visit("amplitude_world_mps", config.amplitude_world_mps, -20.0, 20.0,
        "velocity that the fully grown gust adds to the wind, in world axes; zero: no gust");
}

void visit_fields(FieldVisitor& visit, WindConfig& config) {
  visit("reference_height_m", config.reference_height_m, 3.0, 100.0,
        "height at which the mean wind is wind_world_mps; 20 ft in MIL-F-8785C | MIL-F-8785C");
  visit("roughness_m", config.roughness_m, 0.0, 2.0,
        "Roughness length of the logarithmic wind profile, mean(h) = mean(reference) ln(h / roughness) / "
        "ln(reference / roughness); below 3 ft the wind is that at 3 ft. MIL-F-8785C: 0.0457 (0.15 ft) at "
        "airfields, 0.61 (2 ft) elsewhere. 0: the same wind at all heights. | MIL-F-8785C");
  visit("turbulence_wind20_mps", config.turbulence_wind20_mps, 0.0, 50.0,
        "Strength of the Dryden turbulence, stated as the mean wind at 20 ft that would cause it. "
        "MIL-F-8785C: 7.7 m/s is light, 15.4 moderate, 23.2 severe turbulence. 0: none. | MIL-F-8785C");
  visit("gust", config.gust);
  visit(
      "shelter_factor", config.shelter_factor, 0.0, 1.0,
      "Wind inside the forest, below the tops of its trunks, as a share of the wind outside, gusts included. "
      "Andrews 2012 (USDA RMRS-GTR-266), wind adjustment factors from Albini & Baughman 1979: 0.1 to 0.2 "
      "under closed crowns, 0.3 partly sheltered. 1: no shelter. | Albini & Baughman 1979; Andrews 2012");
  visit("shelter_edge_m", config.shelter_edge_m, 0.1, 100.0,
        "Distance inwards from the forest's edge over which the wind falls linearly to wind.shelter_factor: "
        "a canopy's height or more (Belcher, Jerram & Hunt 2003, adjustment of wind to a canopy). | Belcher, "
        "Jerram & Hunt 2003");
}

}  // namespace understory
