#include "tests/validation/free_flight.hpp"

#include <cmath>
#include <stdexcept>

#include "sim/aircraft/aerodynamics.hpp"

namespace understory {
AirborneStart trimmed_start(const Airframe& airframe, double airspeed_mps) {
  const std::optional<Trim> trim = straight_trim(airframe, airspeed_mps);
  if (!trim) throw std::logic_error("trimmed_start: no level flight at this speed");
  const double attack = trim->angle_of_attack_rad;
  AirborneStart start;
  start.R_world_body = Eigen::AngleAxisd(-attack, Eigen::Vector3d::UnitY()).toRotationMatrix();
  start.velocity_body_mps = airspeed_mps * Eigen::Vector3d(std::cos(attack), 0, -std::sin(attack));
  start.controls = {trim->elevon_rad, trim->elevon_rad, trim->thrust_n};
  return start;
}

FreeFlight::FreeFlight(const Airframe& airframe)
    : world_(build_world(UNDERSTORY_SOURCE_DIR "/models", airframe, {}, WorldConfig{})) {}

Aircraft FreeFlight::begin(const Airframe& airframe, const AirborneStart& start) const {
  Aircraft aircraft(*world_.model, airframe, LaunchConfig{}, Eigen::Vector3d::Zero());
  Eigen::Isometry3d pose(start.R_world_body);
  pose.translation() = Eigen::Vector3d(0, 0, start_altitude_m);
  aircraft.place(pose, start.R_world_body * start.velocity_body_mps, start.angular_rate_body_radps,
                 start.controls);
  return aircraft;
}

}  // namespace understory
