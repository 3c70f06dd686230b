#pragma once

#include <Eigen/Geometry>

#include "estimation/state.hpp"
#include "planning/airframe.hpp"
#include "planning/autopilot_config.hpp"

namespace understory {

/// Where the aircraft is and how it moves through the air, in wind axes: the state of the reduced model that
/// plans are made with. Angles follow our body frame (x forward, y left, z up): a positive bank has the right
/// wing down and turns to the right, so that the heading (counted from world x towards world y) falls.
struct FlightState {
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  Eigen::Vector2d wind_world_mps = Eigen::Vector2d::Zero();  ///< of the air, which carries all of it along
  double speed_mps = 12;
  double heading_rad = 0;      ///< of the velocity through the air
  double climb_angle_rad = 0;  ///< of the velocity through the air
  double bank_rad = 0;         ///< of the wings about the velocity
  double roll_rate_radps = 0;  ///< about body x
  double angle_of_attack_rad = 0.19;
  double sideslip_rad = 0;    ///< positive: moving to the left of where the nose points
  double yaw_rate_radps = 0;  ///< about body z
};

/// The command to the aircraft: the two controls of the planner's space.
struct FlightCommand {
  double bank_rad = 0;
  double climb_mps = 0;
  bool operator==(const FlightCommand&) const = default;
};

/// A point mass with roll-in, speed loss and sideslip, under the forces of the identified flat plates
/// (docs/sources.md [3]). The inner loops of the path follower appear as lags, so steps of 20 ms are
/// accurate.
class FlightModel {
 public:
  FlightModel(const Airframe& airframe, const FlightModelConfig& config);

  /// The state `dt_s` later (0 < dt_s <= 0.03) with `command` held.
  FlightState advance(const FlightState& state, const FlightCommand& command, double dt_s) const;

  /// The angle of attack that bends the path towards the commanded climb, within the envelope.
  double commanded_angle_of_attack_rad(const FlightState& state, double climb_mps) const {
    return commanded_angle_of_attack_rad(state, climb_mps, Attitude(state));
  }
  /// The roll rate about the velocity that removes the bank error, within the limits of the elevons.
  double commanded_roll_rate_radps(const FlightState& state, double bank_rad) const;
  double commanded_thrust_n(const FlightState& state) const;
  /// Roll moment per radian of differential deflection (left down, right up) at this speed.
  double elevon_roll_moment_nm_per_rad(double speed_mps) const;
  /// Pitch moment per radian of common deflection, where that is the roll moment per radian.
  double elevon_pitch_moment_nm_per_rad(double roll_slope_nm) const {
    return roll_slope_nm / airframe_.elevon_y_m * elevon_arm_m_;
  }
  /// Roll moment per roll rate that the body and the elevons' own motion through the air take.
  double roll_damping_nms(double roll_slope_nm, double speed_mps) const {
    return airframe_.rate_damping_nmspr.x() + roll_slope_nm * airframe_.elevon_y_m / speed_mps;
  }
  /// The differential deflection that makes this roll moment, within its limit. A flat plate's lift goes with
  /// sin(2 a) / 2: this inverts it.
  double differential_rad(double roll_moment_nm, double roll_slope_nm) const;
  double reachable_roll_acceleration_radps2(const FlightState& state, double wanted_radps2) const;
  /// The body's pitch rate (nose up positive) that brings the angle of attack to what is wanted, as far as
  /// the elevons can while they make this roll moment: a wing that rolls as fast as it can pulls little.
  double body_pitch_rate_radps(const FlightState& state, double wanted_attack_rad,
                               double path_pitch_rate_radps, double roll_moment_nm, double dt_s) const;
  /// Side force of the winglets along body y (to the left positive).
  double side_force_n(const FlightState& state) const;
  /// Distance of the elevons' mid-chord behind the centre of mass.
  double elevon_arm_m() const { return elevon_arm_m_; }
  /// Rate of turn of the path in the body's pitch plane (nose up positive) that this angle of attack makes.
  double path_pitch_rate_radps(const FlightState& state) const {
    return path_pitch_rate_radps(state, Attitude(state));
  }

  /// The highest speed up to 20 m/s that full thrust holds in level flight; 0 if there is none.
  double fastest_level_mps() const;

  const Airframe& airframe() const { return airframe_; }
  const FlightModelConfig& config() const { return config_; }

 private:
  /// Sines and cosines that several terms of a step need. They are most of its cost.
  struct Attitude {
    explicit Attitude(const FlightState& state);
    double sin_alpha, cos_alpha, sin_bank, cos_bank, sin_climb, cos_climb;
  };
  double path_pitch_rate_radps(const FlightState& state, const Attitude& attitude) const;
  double commanded_angle_of_attack_rad(const FlightState& state, double climb_mps,
                                       const Attitude& attitude) const;

  Airframe airframe_;
  FlightModelConfig config_;
  double lifting_area_m2_;  ///< the wing's, times its lift factor
  double elevon_arm_m_;
  double sin_twice_differential_;  ///< of the maximum differential deflection
  double level_thrust_n_;
};

/// Direction of the velocity over ground, from world x towards world y: the heading if there is no wind.
double course_rad(const FlightState& state);
/// Unit vector from the centre to the left wing tip, world frame.
Eigen::Vector3d left_wing_direction_world(const FlightState& state);
/// Unit vector of the velocity through the air, world frame.
Eigen::Vector3d flight_direction_world(const FlightState& state);

/// The state of this aircraft in the reduced model; the velocity is over ground, as an estimator gives it.
FlightState flight_state(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_body_mps,
                         const Eigen::Vector3d& angular_rate_body_radps,
                         const Eigen::Vector2d& wind_world_mps = Eigen::Vector2d::Zero());
/// The same from the estimate, with its wind and gust. The gust is taken as constant over the planning
/// horizon: at flight height, the air changes little within some 50 m (MIL-F-8785C).
FlightState flight_state(const State& state);

}  // namespace understory
