#include "planning/flight_model.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

constexpr double reference_speed_mps = 12.27;  // level trim of the identified model

double dynamic_pressure_pa(const Airframe& airframe, double speed_mps) {
  return 0.5 * airframe.air_density_kgpm3 * speed_mps * speed_mps;
}

}  // namespace

FlightModel::FlightModel(const Airframe& airframe, const FlightModelConfig& config)
    : airframe_(airframe),
      config_(config),
      lifting_area_m2_(airframe.wing_area_m2 * airframe.wing_lift_factor),
      elevon_arm_m_(-airframe.elevon_hinge_x_m + 0.5 * airframe.elevon_chord_m),
      sin_twice_differential_(std::sin(2 * config.maximum_differential_rad)) {
  // Level flight at cruise speed: lift carries the weight, thrust carries what drag the plate and the body
  // make.
  const double q = dynamic_pressure_pa(airframe_, config_.cruise_speed_mps);
  const double weight_n = airframe_.mass_kg * airframe_.gravity_mps2;
  const double sine = std::min(0.7, weight_n / (2 * q * lifting_area_m2_));
  const double drag_to_lift = airframe_.wing_drag_factor / airframe_.wing_lift_factor;
  level_thrust_n_ =
      std::min(airframe_.max_thrust_n, weight_n * sine * drag_to_lift + q * airframe_.body_drag_area_m2);
}

double FlightModel::fastest_level_mps() const {
  const double weight_n = airframe_.mass_kg * airframe_.gravity_mps2, thrust_n = airframe_.max_thrust_n;
  const double drag_to_lift = airframe_.wing_drag_factor / airframe_.wing_lift_factor;
  for (double speed_mps = 20; speed_mps > 1; speed_mps -= 0.01) {
    const double q = dynamic_pressure_pa(airframe_, speed_mps);
    double sine = 0, cosine = 1;  // of the angle of attack: plate and thrust carry the weight
    for (int i = 0; i < 20; ++i) {
      sine = std::min(0.7, weight_n / (2 * cosine * q * lifting_area_m2_ + thrust_n));
      cosine = std::sqrt(1 - sine * sine);
    }
    const double drag_n =
        2 * sine * sine * q * lifting_area_m2_ * drag_to_lift + q * airframe_.body_drag_area_m2;
    if (sine < 0.7 && drag_n <= thrust_n * cosine) return speed_mps;
  }
  return 0;
}

FlightModel::Attitude::Attitude(const FlightState& state)
    : sin_alpha(std::sin(state.angle_of_attack_rad)),
      cos_alpha(std::cos(state.angle_of_attack_rad)),
      sin_bank(std::sin(state.bank_rad)),
      cos_bank(std::cos(state.bank_rad)),
      sin_climb(std::sin(state.climb_angle_rad)),
      cos_climb(std::cos(state.climb_angle_rad)) {}

double FlightModel::path_pitch_rate_radps(const FlightState& state, const Attitude& attitude) const {
  const double q = dynamic_pressure_pa(airframe_, state.speed_mps);
  const double normal_n = 2 * attitude.sin_alpha * q * lifting_area_m2_;
  const double weight_n = airframe_.mass_kg * airframe_.gravity_mps2;
  const double carried_n = weight_n * attitude.cos_climb * attitude.cos_bank;
  return (normal_n * attitude.cos_alpha - carried_n) / (airframe_.mass_kg * state.speed_mps);
}

double FlightModel::commanded_angle_of_attack_rad(const FlightState& state, double climb_mps,
                                                  const Attitude& attitude) const {
  const double speed = std::max(state.speed_mps, 4.0);
  const double q = dynamic_pressure_pa(airframe_, speed);
  const double wanted_climb_angle = std::asin(std::clamp(climb_mps / speed, -0.5, 0.5));
  const double turn_up_radps = (wanted_climb_angle - state.climb_angle_rad) / config_.climb_angle_time_s;
  const double upward_n =
      airframe_.mass_kg * (speed * turn_up_radps + airframe_.gravity_mps2 * attitude.cos_climb);
  // Beyond 80 deg of bank the wing cannot carry the weight. The command is that of 80 deg, where the cap of
  // the angle of attack applies.
  const double share = std::max(attitude.cos_bank, 0.17);
  // Lift is N cos(a) + X sin(a) with N = 2 sin(a) q S and X = thrust less body drag; cos(a) taken as now.
  const double forward_n = commanded_thrust_n(state) - q * airframe_.body_drag_area_m2;
  const double sine = upward_n / (share * (2 * q * lifting_area_m2_ * attitude.cos_alpha + forward_n));
  // Near the minimum speed a larger angle of attack only costs speed, so its cap approaches that of level
  // flight.
  const double reserve = std::clamp((speed - config_.minimum_speed_mps + 0.5) / 1.0, 0.6, 1.0);
  return std::clamp(std::asin(std::clamp(sine, -0.9, 0.9)), config_.minimum_angle_of_attack_rad,
                    reserve * config_.maximum_angle_of_attack_rad);
}

double FlightModel::commanded_roll_rate_radps(const FlightState& state, double bank_rad) const {
  const double maximum = config_.maximum_roll_rate_radps * state.speed_mps / reference_speed_mps;
  return std::clamp(config_.bank_gain_per_s * (bank_rad - state.bank_rad), -maximum, maximum);
}

double FlightModel::side_force_n(const FlightState& state) const {
  const double speed = std::max(state.speed_mps, 4.0);
  const double winglet_sideslip = state.sideslip_rad + airframe_.winglet_x_m * state.yaw_rate_radps / speed;
  return -2 * std::sin(winglet_sideslip) * dynamic_pressure_pa(airframe_, speed) * 2 *
         airframe_.winglet_area_m2;
}

double FlightModel::elevon_roll_moment_nm_per_rad(double speed_mps) const {
  // Two elevons, flat-plate slope 2 per radian, times the identified lift factor.
  return 2 * airframe_.elevon_y_m * 2 * airframe_.elevon_lift_factor * airframe_.elevon_area_m2 *
         dynamic_pressure_pa(airframe_, speed_mps);
}

double FlightModel::differential_rad(double roll_moment_nm, double roll_slope_nm) const {
  const double share = std::clamp(roll_moment_nm / roll_slope_nm, -0.5, 0.5);
  return std::clamp(0.5 * std::asin(2 * share), -config_.maximum_differential_rad,
                    config_.maximum_differential_rad);
}

double FlightModel::reachable_roll_acceleration_radps2(const FlightState& state, double wanted_radps2) const {
  const double slope_nm = elevon_roll_moment_nm_per_rad(state.speed_mps);
  const double damping_nms = roll_damping_nms(slope_nm, std::max(state.speed_mps, 4.0));
  const double maximum_nm = slope_nm * 0.5 * sin_twice_differential_;
  const double damped_nm = damping_nms * state.roll_rate_radps;
  return std::clamp(wanted_radps2, (-maximum_nm - damped_nm) / airframe_.inertia_kgm2.x(),
                    (maximum_nm - damped_nm) / airframe_.inertia_kgm2.x());
}

double FlightModel::body_pitch_rate_radps(const FlightState& state, double wanted_attack_rad,
                                          double path_pitch_rate_radps, double roll_moment_nm,
                                          double dt_s) const {
  const double wanted_rad = wanted_attack_rad - state.angle_of_attack_rad;
  const double wanted_radps =
      path_pitch_rate_radps + wanted_rad * (1 - std::exp(-dt_s / config_.angle_of_attack_time_s)) / dt_s;
  const double speed = std::max(state.speed_mps, 4.0), slope_nm = elevon_roll_moment_nm_per_rad(speed);
  const double damped_nm = roll_damping_nms(slope_nm, speed) * state.roll_rate_radps;
  const double rolling_rad = std::abs(differential_rad(roll_moment_nm + damped_nm, slope_nm));
  // What rolling leaves of the elevons' travel balances the pitch damping.
  const double collective_s =
      elevon_arm_m_ / speed + airframe_.rate_damping_nmspr.y() / elevon_pitch_moment_nm_per_rad(slope_nm);
  const double up_rad = airframe_.elevon_max_rad - rolling_rad - state.angle_of_attack_rad;
  const double down_rad = airframe_.elevon_min_rad + rolling_rad - state.angle_of_attack_rad;
  return std::clamp(wanted_radps, down_rad / collective_s, up_rad / collective_s);
}

double FlightModel::commanded_thrust_n(const FlightState& state) const {
  const double error_mps = config_.cruise_speed_mps - state.speed_mps;
  return std::clamp(level_thrust_n_ + config_.speed_gain_n_per_mps * error_mps, 0.0, airframe_.max_thrust_n);
}

FlightState FlightModel::advance(const FlightState& state, const FlightCommand& command, double dt_s) const {
  const double mass = airframe_.mass_kg;
  const double speed = std::max(state.speed_mps, 4.0);
  const double q = dynamic_pressure_pa(airframe_, speed);
  const Attitude attitude(state);
  const auto [sin_alpha, cos_alpha, sin_bank, cos_bank, sin_climb, cos_climb] = attitude;
  const double gravity = airframe_.gravity_mps2;
  const Eigen::Vector3d& inertia = airframe_.inertia_kgm2;

  // Inner loops of the path follower, as lags.
  const double wanted_velocity_roll = commanded_roll_rate_radps(state, command.bank_rad);
  const double wanted_roll = (wanted_velocity_roll + state.yaw_rate_radps * sin_alpha) / cos_alpha;
  const double roll_acceleration = reachable_roll_acceleration_radps2(
      state, (wanted_roll - state.roll_rate_radps) * (1 - std::exp(-dt_s / config_.roll_time_s)) / dt_s);
  const double wanted_alpha = commanded_angle_of_attack_rad(state, command.climb_mps, attitude);
  const double side_n = side_force_n(state);

  // Forces along body z (wing, less the elevons' share that balances the pitch damping), body y (winglets),
  // thrust.
  const double pitch_rate = path_pitch_rate_radps(state, attitude);
  const double body_pitch_rate =
      body_pitch_rate_radps(state, wanted_alpha, pitch_rate,
                            inertia.x() * roll_acceleration + airframe_.winglet_z_m * side_n, dt_s);
  const double balance_n = airframe_.rate_damping_nmspr.y() * body_pitch_rate / elevon_arm_m_;
  const double normal_n = 2 * sin_alpha * q * lifting_area_m2_ - balance_n;
  // Body drag was identified along body x, like the thrust. Both turn with the nose.
  const double forward_n =
      commanded_thrust_n(state) - q * airframe_.body_drag_area_m2 * cos_alpha * cos_alpha;
  const double lift_n = normal_n * cos_alpha + forward_n * sin_alpha;
  // Drag of the wing beyond that of the plate, which the normal force contains. Zero by default.
  const double more_drag_m2 = airframe_.wing_area_m2 * airframe_.wing_drag_factor - lifting_area_m2_;
  const double drag_n = normal_n * sin_alpha - forward_n * cos_alpha - side_n * std::sin(state.sideslip_rad) +
                        2 * sin_alpha * sin_alpha * q * more_drag_m2;

  // Yaw: winglets turn the nose into the wind; the elevons' lift, perpendicular to the flow, leans forward by
  // the angle of attack and so yaws as it rolls; gyroscopic coupling of roll and pitch.
  const double roll_moment = inertia.x() * roll_acceleration +
                             airframe_.rate_damping_nmspr.x() * state.roll_rate_radps +
                             airframe_.winglet_z_m * side_n;
  const double yaw_moment = airframe_.winglet_x_m * side_n - roll_moment * sin_alpha / cos_alpha -
                            (inertia.x() - inertia.y()) * state.roll_rate_radps * pitch_rate;

  FlightState next = state;
  next.roll_rate_radps += dt_s * roll_acceleration;
  next.angle_of_attack_rad += dt_s * (body_pitch_rate - pitch_rate);
  next.yaw_rate_radps += dt_s * yaw_moment / inertia.z();
  const double roll_rate = 0.5 * (state.roll_rate_radps + next.roll_rate_radps);
  const double yaw_rate = 0.5 * (state.yaw_rate_radps + next.yaw_rate_radps);
  next.sideslip_rad += dt_s * ((side_n - mass * gravity * cos_climb * sin_bank) / (mass * speed) -
                               yaw_rate * cos_alpha - roll_rate * sin_alpha);
  next.bank_rad += dt_s * (roll_rate * cos_alpha - yaw_rate * sin_alpha);
  next.speed_mps = std::max(4.0, state.speed_mps + dt_s * (-drag_n / mass - gravity * sin_climb));
  const double turn_up =
      (lift_n * cos_bank + side_n * sin_bank - mass * gravity * cos_climb) / (mass * speed);
  const double turn_left =
      (side_n * cos_bank - lift_n * sin_bank) / (mass * speed * std::max(cos_climb, 0.3));
  next.climb_angle_rad = std::clamp(state.climb_angle_rad + dt_s * turn_up, -1.2, 1.2);
  next.heading_rad += dt_s * turn_left;

  const double mean_heading = 0.5 * (state.heading_rad + next.heading_rad);
  const double mean_climb = 0.5 * (state.climb_angle_rad + next.climb_angle_rad);
  const double distance = dt_s * 0.5 * (state.speed_mps + next.speed_mps);
  const double cos_mean_climb = std::cos(mean_climb);
  next.position_world +=
      distance * Eigen::Vector3d(cos_mean_climb * std::cos(mean_heading),
                                 cos_mean_climb * std::sin(mean_heading), std::sin(mean_climb));
  next.position_world.head<2>() += dt_s * state.wind_world_mps;
  return next;
}

double course_rad(const FlightState& state) {
  if (state.wind_world_mps.isZero(0)) return state.heading_rad;
  const Eigen::Vector2d over_ground_mps =
      state.speed_mps * flight_direction_world(state).head<2>() + state.wind_world_mps;
  return std::atan2(over_ground_mps.y(), over_ground_mps.x());
}

Eigen::Vector3d flight_direction_world(const FlightState& state) {
  const double cos_climb = std::cos(state.climb_angle_rad);
  return {cos_climb * std::cos(state.heading_rad), cos_climb * std::sin(state.heading_rad),
          std::sin(state.climb_angle_rad)};
}

Eigen::Vector3d left_wing_direction_world(const FlightState& state) {
  const Eigen::Vector3d left(-std::sin(state.heading_rad), std::cos(state.heading_rad), 0);
  const Eigen::Vector3d up = flight_direction_world(state).cross(left);
  return std::cos(state.bank_rad) * left + std::sin(state.bank_rad) * up;
}

FlightState flight_state(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_body_mps,
                         const Eigen::Vector3d& angular_rate_body_radps,
                         const Eigen::Vector2d& wind_world_mps) {
  FlightState state;
  const Eigen::Matrix3d rotation = T_world_body.linear();
  Eigen::Vector3d velocity = rotation * velocity_body_mps;
  velocity.head<2>() -= wind_world_mps;
  state.wind_world_mps = wind_world_mps;
  state.position_world = T_world_body.translation();
  state.speed_mps = velocity.norm();
  state.roll_rate_radps = angular_rate_body_radps.x();
  state.yaw_rate_radps = angular_rate_body_radps.z();
  // At rest in the air the velocity has no direction. Take that of the nose.
  const Eigen::Vector3d direction =
      state.speed_mps > 1.0 ? Eigen::Vector3d(velocity / state.speed_mps) : Eigen::Vector3d(rotation.col(0));
  const Eigen::Vector3d in_body = rotation.transpose() * direction;
  state.heading_rad = std::atan2(direction.y(), direction.x());
  state.climb_angle_rad = std::asin(std::clamp(direction.z(), -1.0, 1.0));
  state.angle_of_attack_rad = std::atan2(-in_body.z(), in_body.x());
  state.sideslip_rad = std::asin(std::clamp(in_body.y(), -1.0, 1.0));
  const Eigen::Vector3d left(-std::sin(state.heading_rad), std::cos(state.heading_rad), 0);
  const Eigen::Vector3d up = direction.cross(left);
  state.bank_rad = std::atan2(rotation.col(1).dot(up), rotation.col(1).dot(left));
  return state;
}

FlightState flight_state(const State& state) {
  return flight_state(state.T_world_body, state.velocity_body_mps, state.angular_rate_body_radps,
                      state.wind_world_mps + state.gust_world_mps);
}

}  // namespace understory
