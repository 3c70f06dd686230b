#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "tests/validation/steady_flight.hpp"
#include "sim/aircraft/aerodynamics.hpp"

namespace understory {

/// What moves, without position and heading, on which nothing depends: body velocity (3), body rate (3),
/// roll, pitch (yaw about z, then pitch about y, then roll about x; pitch positive nose down).
using BodyMotion = Eigen::Matrix<double, 8, 1>;

/// Rigid body under the simulator's aerodynamics and gravity, in still air. `surfaces`: elevons and thrust;
/// the rest of it is not read.
BodyMotion rate_of_change(const Airframe& airframe, const BodyMotion& motion, const AirState& surfaces);

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
