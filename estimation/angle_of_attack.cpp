#include "estimation/measurements.hpp"

#include <cmath>

namespace understory {

Measurement<1> angle_of_attack(const State& state, double normal_mps2, const AngleOfAttackConfig& config,
                               FilterModel model) {
  const AirVelocity air = air_velocity(state);
  const double forward = air.body_mps.x(), upward = air.body_mps.z();
  const double speed = std::hypot(forward, upward);
  const double factor = config.air_density_kgpm3 * config.wing_area_m2 / config.mass_kg;
  // Nose-up is negative about the left-pointing y: the elevons then push down.
  const double elevon_factor = config.pitch_damping_nmspr / (config.elevon_arm_m * config.mass_kg);
  const double predicted = -factor * speed * upward + elevon_factor * state.angular_rate_body_radps.y();

  Measurement<1> measurement;
  measurement.innovation[0] = normal_mps2 - state.accelerometer_bias_mps2.z() - predicted;
  const Eigen::RowVector3d by_air(-factor * forward * upward / speed, 0.0,
                                  -factor * (speed + upward * upward / speed));
  measurement.jacobian = by_air * air.jacobian;
  measurement.jacobian(0, accelerometer_bias_block + 2) = 1;
  measurement.jacobian(0, rate_block + 1) = rate_sign(model) * elevon_factor;
  const double wrong = config.model_error * predicted;
  measurement.noise(0, 0) = config.sigma_mps2 * config.sigma_mps2 + wrong * wrong;
  return measurement;
}

}  // namespace understory
