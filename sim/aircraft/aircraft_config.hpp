#pragma once

#include <Eigen/Core>

#include "planning/airframe.hpp"

namespace understory {

class FieldVisitor;

/// How a flight begins: held on a catapult, then released with the wings level.
struct LaunchConfig {
  double speed_mps = 12.0;
  double altitude_m = 1.5;
  double climb_angle_rad = 0.20;
  double rail_length_m = 1.5;
  double rest_s = 0.25;
};

void visit_fields(FieldVisitor& visit, LaunchConfig& config);

/// Dynamics between a command and its effect on the air. The identified model has none (its airframe answers
/// one input delay later, at once and in full), so every part is off by default, at 0. The flight record
/// cannot separate delay from lag (docs/flight_model.md), so the values in the keys' meanings are typical and
/// none is fitted.
struct ActuatorsConfig {
  double elevon_time_s = 0;
  double elevon_rate_radps = 0;
  double motor_time_s = 0;
  double pitch_speed_mps = 0;
  double thrust_speed_mps = 12.27;
  double propwash_share = 0;
  double propeller_diameter_m = 0.18;
  double torque_per_thrust_m = 0;
};

void visit_fields(FieldVisitor& visit, ActuatorsConfig& config);

/// Difference between the aircraft that flies and the airframe that the stack believes in, in percent of the
/// stack's value: 10 is a tenth more, 0 the same.
struct MismatchConfig {
  double mass_percent = 0;
  double lift_percent = 0;
  double drag_percent = 0;
  double damping_percent = 0;
  double delay_percent = 0;
};

void visit_fields(FieldVisitor& visit, MismatchConfig& config);

/// The airframe that flies.
Airframe mismatched(Airframe airframe, const MismatchConfig& mismatch);

/// One discrete gust of MIL-F-8785C: from start_s on it builds up as half a cosine over the distance flown
/// through the air, amplitude / 2 (1 - cos(pi x / length)), and then stays.
struct GustConfig {
  double start_s = 2;
  double length_m = 10;
  Eigen::Vector3d amplitude_world_mps = Eigen::Vector3d::Zero();
};

/// Wind in addition to the mean. Everything is off by default.
struct WindConfig {
  double reference_height_m = 6.096;
  double roughness_m = 0;
  double turbulence_wind20_mps = 0;
  GustConfig gust;
  double shelter_factor = 1;
  double shelter_edge_m = 10;
};

void visit_fields(FieldVisitor& visit, WindConfig& config);

/// Where the forest stands, and so where its shelter is. Nowhere by default.
struct ForestStand {
  double from_x_m = 0;
  double to_x_m = 0;
  double half_width_m = 0;  ///< |y|
  double canopy_top_m = 0;
};

}  // namespace understory
