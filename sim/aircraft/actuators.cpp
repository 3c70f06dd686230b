#include "sim/aircraft/actuators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

/// Exact for a command held over the step; the rate limit then cuts the step. 0 stands for no lag, no limit.
double followed(double now, double commanded, double time_s, double rate_per_s, double step_s) {
  if (time_s == 0 && rate_per_s == 0) return commanded;
  const double share = time_s > 0 ? -std::expm1(-step_s / time_s) : 1;
  const double change = share * (commanded - now);
  const double maximum = rate_per_s > 0 ? rate_per_s * step_s : std::abs(change);
  return now + std::clamp(change, -maximum, maximum);
}

}  // namespace

void Actuators::advance(const Controls& commanded, double step_s) {
  const auto elevon = [&](double& now, double wanted) {
    now = followed(now, wanted, config_.elevon_time_s, config_.elevon_rate_radps, step_s);
  };
  elevon(now_.left_elevon_rad, commanded.left_elevon_rad);
  elevon(now_.right_elevon_rad, commanded.right_elevon_rad);
  now_.thrust_n = followed(now_.thrust_n, commanded.thrust_n, config_.motor_time_s, 0, step_s);
}

double Actuators::thrust_n(double forward_airspeed_mps) const {
  if (config_.pitch_speed_mps == 0) return now_.thrust_n;
  const double left_mps = config_.pitch_speed_mps - std::max(0.0, forward_airspeed_mps);
  return std::max(0.0, now_.thrust_n * left_mps / (config_.pitch_speed_mps - config_.thrust_speed_mps));
}

/// T = rho A (V + w / 2) w for the wake's increment w, solved for w.
double Actuators::elevon_wash_mps(double forward_airspeed_mps, double air_density_kgpm3) const {
  if (config_.propwash_share == 0) return 0;
  const double disc_m2 =
      0.25 * std::numbers::pi * config_.propeller_diameter_m * config_.propeller_diameter_m;
  const double speed = std::max(0.0, forward_airspeed_mps);
  const double loading = 2 * thrust_n(forward_airspeed_mps) / (air_density_kgpm3 * disc_m2);
  return config_.propwash_share * (std::sqrt(speed * speed + loading) - speed);
}

double Actuators::motor_torque_nm(double forward_airspeed_mps) const {
  return config_.torque_per_thrust_m * thrust_n(forward_airspeed_mps);
}

}  // namespace understory
