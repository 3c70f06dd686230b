#pragma once

#include "estimation/error_state.hpp"
#include "estimation/samples.hpp"

namespace understory {

/// The magnetometer's field, rotated into the world by the estimated attitude (which compensates the tilt),
/// points to magnetic north, world y. Only its horizontal direction is used, not its strength or inclination.
struct HeadingConfig {
  bool enabled = true;
  /// rad, 0.01..3. A hard-iron error of 0.5 uT against a horizontal field of 19 uT (48 uT, inclination 67
  /// deg) is 0.027 rad and lasts the flight, and a tilt error enters tan(67 deg) = 2.4 fold: the magnetometer
  /// holds the heading over minutes and leaves seconds to the gyro.
  double sigma_rad = 0.35;
  double minimum_horizontal_ut = 5.0;  ///< uT, 0..100: below this the direction means nothing
};

template <typename Visitor>
void visit_fields(Visitor& visit, HeadingConfig& config) {
  visit("enabled", config.enabled);
  visit("sigma_rad", config.sigma_rad, 0.01, 3.0);
  visit("minimum_horizontal_ut", config.minimum_horizontal_ut, 0.0, 100.0);
}

/// Horizontal strength of the field under the estimated attitude, microtesla.
double horizontal_field_ut(const State& state, const MagnetometerSample& sample);

/// Innovation: by how much the aircraft's heading is left (counter-clockwise) of the estimate, rad, in (-pi,
/// pi]. The jacobian includes the tilt and is that of a field due north. Precondition: horizontal_field_ut >
/// 0.
Measurement<1> heading(const State& state, const MagnetometerSample& sample, const HeadingConfig& config);

}  // namespace understory
