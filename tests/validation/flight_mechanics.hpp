#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "planning/airframe.hpp"
#include "sim/aircraft/aerodynamics.hpp"

namespace understory {

/// What moves, without position and heading, on which nothing depends: body velocity (3), body rate (3),
/// roll, pitch (yaw about z, then pitch about y, then roll about x; pitch positive nose down).
using BodyMotion = Eigen::Matrix<double, 8, 1>;

/// Rigid body under the simulator's aerodynamics and gravity, in still air. `surfaces`: elevons and thrust;
/// the rest of it is not read.
BodyMotion rate_of_change(const Airframe& airframe, const BodyMotion& motion, const AirState& surfaces);

/// Flight in which nothing turns faster or slower: straight, or in a circle, climbing or sinking along a
/// helix; and, as if frozen at one moment, gaining or losing speed along the path.
struct SteadyFlight {
  double airspeed_mps = 0;
  double bank_rad = 0;         ///< of the lift about the velocity, right wing down positive
  double climb_angle_rad = 0;  ///< of the velocity
  double thrust_n = 0;
  double acceleration_mps2 = 0;  ///< along the path
  double angle_of_attack_rad = 0;
  double sideslip_rad = 0;
  double left_elevon_rad = 0;
  double right_elevon_rad = 0;
  double turn_rate_radps = 0;  ///< of the heading, to the right positive
  double load_factor = 0;      ///< lift of wings and thrust over the weight

  double radius_m() const;
  double sink_mps() const;
  BodyMotion motion() const;
  AirState air() const;  ///< what the aerodynamics are asked
};

enum class Solved { thrust, acceleration, climb_angle };

/// Newton's method on all six equations of the flat-plate aircraft, from `given`'s airspeed, bank, and those
/// two of thrust, acceleration and climb angle that are not `solved` for. Elevons and thrust may come out
/// beyond their limits; empty where the angle of attack passes `max_angle_of_attack_rad` or nothing is found.
std::optional<SteadyFlight> steady_flight(const Airframe& airframe, const SteadyFlight& given, Solved solved,
                                          double max_angle_of_attack_rad = 0.5236);

/// Level turn at this bank with all the thrust: what speed does is solved for.
std::optional<SteadyFlight> full_thrust_turn(const Airframe& airframe, double speed_mps, double bank_rad,
                                             double max_angle_of_attack_rad);
/// The steepest level turn with all the thrust that gains at least this much speed. Nothing comes out with
/// nan everywhere.
SteadyFlight steepest_turn(const Airframe& airframe, double speed_mps, double acceleration_mps2,
                           double max_angle_of_attack_rad);
/// The steepest of all: at the cap of the angle of attack, losing speed.
inline SteadyFlight hardest_turn(const Airframe& airframe, double speed_mps, double max_angle_of_attack_rad) {
  return steepest_turn(airframe, speed_mps, -HUGE_VAL, max_angle_of_attack_rad);
}

/// The last of 40 points halfway between `yes`, where `holds`, and `no`, where it does not.
template <typename Holds>
double border(double yes, double no, Holds&& holds) {
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (yes + no);
    (holds(middle) ? yes : no) = middle;
  }
  return yes;
}

/// One way in which the aircraft, its controls held, comes back to trim or leaves it.
struct Mode {
  std::string name;
  std::complex<double> eigenvalue;  ///< of a swinging mode the one with positive imaginary part; 1/s

  bool swings() const { return eigenvalue.imag() > 0; }
  double frequency_radps() const { return std::abs(eigenvalue); }  ///< undamped
  double damping() const { return -eigenvalue.real() / std::abs(eigenvalue); }
  double time_constant_s() const { return -1 / eigenvalue.real(); }  ///< negative: it grows
};

struct Modes {
  std::vector<Mode> longitudinal;  ///< fastest first
  std::vector<Mode> lateral;
  /// The largest slope by which one set moves the other: 0 for a symmetric aircraft in straight flight.
  double coupling = 0;
};

/// Eigenvalues of the numerical Jacobian about a straight steady flight. Longitudinal: short period and
/// phugoid, each one swing or, overdamped, two decays. Lateral: dutch roll, roll subsidence, spiral.
Modes modes(const Airframe& airframe, const SteadyFlight& trim);

}  // namespace understory
