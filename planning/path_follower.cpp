#include "planning/path_follower.hpp"

#include <algorithm>
#include <cmath>

namespace understory {

FlightCommand command_at(const Plan& plan, std::int64_t t_ns) {
  if (plan.points.empty()) return {};
  const double t_s = 1e-9 * static_cast<double>(t_ns - plan.t_ns);
  // Points are few and ordered; each one's command holds until the next.
  const auto after = std::upper_bound(plan.points.begin(), plan.points.end(), t_s,
                                      [](double t, const PlanPoint& point) { return t < point.t_s; });
  const PlanPoint& point = after == plan.points.begin() ? plan.points.front() : *(after - 1);
  return {point.bank_command_rad, point.climb_command_mps};
}

Controls follow(const FlightModel& model, const PathFollowerConfig& config, const FlightCommand& command,
                const State& state) {
  const Airframe& airframe = model.airframe();
  const Eigen::Vector3d& inertia = airframe.inertia_kgm2;
  const FlightState now = flight_state(state);
  const double speed = std::max(now.speed_mps, 5.0);
  const double pitch_rate = -state.angular_rate_body_radps.y();  // nose up positive; body y points left

  // Pitch: the rate that turns the path and removes the error of the angle of attack, then the elevon
  // deflection for it.
  const double alpha_error =
      model.commanded_angle_of_attack_rad(now, command.climb_mps) - now.angle_of_attack_rad;
  const double wanted_pitch_rate =
      model.path_pitch_rate_radps(now) + alpha_error / config.angle_of_attack_time_s;
  const double pitch_acceleration = (wanted_pitch_rate - pitch_rate) / config.pitch_time_s;
  const double arm = model.elevon_arm_m();
  const double roll_slope = model.elevon_roll_moment_nm_per_rad(speed);
  const double pitch_slope = model.elevon_pitch_moment_nm_per_rad(roll_slope);
  const double coupling =
      (inertia.z() - inertia.x()) * now.roll_rate_radps * state.angular_rate_body_radps.z();
  const double pitch_moment =
      inertia.y() * pitch_acceleration + airframe.rate_damping_nmspr.y() * pitch_rate + coupling;
  const double collective = now.angle_of_attack_rad + pitch_rate * arm / speed + pitch_moment / pitch_slope;

  // Roll about the velocity, not about the nose. Otherwise the angle of attack would become sideslip.
  const double wanted_about_velocity = model.commanded_roll_rate_radps(now, command.bank_rad);
  const double wanted_roll =
      (wanted_about_velocity + now.yaw_rate_radps * std::sin(now.angle_of_attack_rad)) /
      std::cos(now.angle_of_attack_rad);
  const double roll_acceleration = (wanted_roll - now.roll_rate_radps) / config.roll_time_s;
  const double roll_moment =
      inertia.x() * roll_acceleration + model.roll_damping_nms(roll_slope, speed) * now.roll_rate_radps +
      airframe.winglet_z_m * model.side_force_n(now);  // the winglets stand above the wing
  const double differential = model.differential_rad(roll_moment, roll_slope);

  // To roll right, the left elevon goes down (it loses less lift there) and the right one up. Where one
  // reaches its stop, both are shifted to keep their difference: a dodge fails by rolling late, not by
  // pulling slightly less.
  const double room = std::abs(differential);
  const double mean = std::clamp(collective, airframe.elevon_min_rad + room, airframe.elevon_max_rad - room);
  Controls controls;
  controls.left_elevon_rad =
      std::clamp(mean - differential, airframe.elevon_min_rad, airframe.elevon_max_rad);
  controls.right_elevon_rad =
      std::clamp(mean + differential, airframe.elevon_min_rad, airframe.elevon_max_rad);
  controls.thrust_n = model.commanded_thrust_n(now);
  return controls;
}

}  // namespace understory
