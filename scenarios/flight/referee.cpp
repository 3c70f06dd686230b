#include "scenarios/flight/referee.hpp"

namespace understory {

std::optional<Outcome> Referee::outcome_at(const Truth& truth, Contact contact, bool released) {
  if (static_cast<double>(truth.t_ns) * 1e-9 >= scenario_.time_limit_s) return Outcome::time;
  if (!released) return std::nullopt;
  if (contact == Contact::obstacle) return Outcome::collision;
  if (contact == Contact::ground) return Outcome::ground;
  const Eigen::Vector3d& place = truth.T_world_body.translation();
  if (place.x() >= scenario_.goal_x_m()) return Outcome::goal;
  climbed_ = climbed_ || place.z() >= scenario_.band.minimum_altitude_m;
  const bool is_low = climbed_ && place.z() < scenario_.band.minimum_altitude_m;
  const bool is_high = place.z() > scenario_.band.maximum_altitude_m;
  const bool is_outside = !scenario_.is_long() && !scenario_.course_rectangle().contains(place.head<2>());
  if (is_low || is_high || is_outside) return Outcome::out_of_bounds;
  return std::nullopt;
}

}  // namespace understory
