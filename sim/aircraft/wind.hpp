#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "sim/aircraft/aircraft_config.hpp"

namespace understory {

/// Dryden turbulence near the ground (MIL-F-8785C, low-altitude model), three components in the axes of the
/// mean wind: x along it, y across it to the left, z up.
struct DrydenScales {
  Eigen::Vector3d length_m;
  Eigen::Vector3d sigma_mps;
};

/// L_w = h, L_u = L_v = h / (0.177 + 0.000823 h)^1.2, sigma_w = 0.1 W20, sigma_u = sigma_v = sigma_w / (0.177
/// + 0.000823 h)^0.4, h in feet above ground, W20 the mean wind at 20 ft (6.1 m). The model is valid from 10
/// to 1000 ft; heights outside use its ends. (MIL-HDBK-1797 writes 2 L for what is L here, for v and w.)
DrydenScales low_altitude_dryden(double altitude_m, double wind20_mps);

/// A frozen field through which the aircraft flies (Taylor). Its state advances with the distance flown
/// through the air, so nothing changes for an aircraft at rest in still air. Each component is white noise
/// through the forming filter of its spectrum, Omega in rad/m, one-sided:
///   u:    2 L / pi / (1 + (L Omega)^2)
///   v, w: L / pi (1 + 3 (L Omega)^2) / (1 + (L Omega)^2)^2
/// Discretised exactly for a step of any length over which L does not change. Rotation of the air (p_g, q_g,
/// r_g) is left out: the span is a quarter of the minimum L_w.
class DrydenTurbulence {
 public:
  /// Begins in the stationary state.
  explicit DrydenTurbulence(std::uint64_t seed);

  void advance(double distance_m, const Eigen::Vector3d& length_m);

  /// The present gust, each component with variance 1. Multiply by sigma_mps for m/s.
  Eigen::Vector3d unit_gust() const;

 private:
  /// 1 / (1 + s) twice in a row, s counted in lengths L, driven by one white noise.
  struct Cascade {
    double first = 0;
    double second = 0;
  };
  double draw() { return unit_(generator_); }
  void advance(Cascade& state, double lengths);

  std::mt19937_64 generator_;
  std::normal_distribution<double> unit_;
  double along_ = 0;
  Cascade across_, up_;
};

/// The air along one flight: mean wind with shear, turbulence, one gust, shelter.
class Wind {
 public:
  /// Steady and the same everywhere.
  explicit Wind(const Eigen::Vector3d& mean_world_mps);
  /// The mean is that at the reference height. Turbulence draws from `seed`, and only if it is on.
  Wind(const Eigen::Vector3d& mean_world_mps, const WindConfig& config, const ForestStand& stand,
       std::uint64_t seed);

  /// One step of the aircraft's way through the air, ending at `t_ns`.
  void advance(std::int64_t t_ns, double step_s, const Eigen::Vector3d& position_world,
               const Eigen::Vector3d& velocity_world_mps);

  /// The wind now. It is valid only at the aircraft's place: turbulence and gust are known along the flight
  /// alone.
  Eigen::Vector3d at(const Eigen::Vector3d& position_world) const;

 private:
  Eigen::Vector3d mean_at(double altitude_m) const;
  double shelter_at(const Eigen::Vector3d& position_world) const;
  Eigen::Vector3d turbulence_at(double altitude_m) const;

  Eigen::Vector3d mean_world_mps_;
  WindConfig config_;
  ForestStand stand_;
  DrydenTurbulence turbulence_;
  double into_gust_m_ = 0;
};

}  // namespace understory
