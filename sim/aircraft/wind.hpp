#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/aircraft/dryden.hpp"

namespace understory {

/// One discrete gust of MIL-F-8785C: from start_s on it builds up as half a cosine over the distance flown
/// through the air, amplitude / 2 (1 - cos(pi x / length)), and then stays.
struct GustConfig {
  double start_s = 2;    ///< of simulated time; the standard launch releases at 0.5 s
  double length_m = 10;  ///< over which it builds up; MIL-F-8785C: tuned to the mode to be excited
  Eigen::Vector3d amplitude_world_mps = Eigen::Vector3d::Zero();  ///< zero: no gust
};

template <typename Visitor>
void visit_fields(Visitor& visit, GustConfig& config) {
  visit("start_s", config.start_s, 0.0, 600.0);
  visit("length_m", config.length_m, 0.1, 1000.0);
  visit("amplitude_world_mps", config.amplitude_world_mps, -20.0, 20.0);
}

/// Wind beside the mean. Everything is off by default.
struct WindConfig {
  double reference_height_m = 6.096;  ///< height of the scenario's mean wind: 20 ft (MIL-F-8785C's W20)
  /// Of the logarithmic profile, mean(h) = mean(reference) ln(h / roughness) / ln(reference / roughness)
  /// above 3 ft. MIL-F-8785C: 0.0457 (0.15 ft) at airfields, 0.61 (2 ft) elsewhere. 0: no shear.
  double roughness_m = 0;
  /// Strength of Dryden turbulence: the mean wind at 20 ft that would make it (MIL-F-8785C: 15, 30, 45 knots,
  /// 7.7, 15.4, 23.2 m/s, are light, moderate, severe). 0: none.
  double turbulence_wind20_mps = 0;
  GustConfig gust;
  /// Share of the wind, its gusts included, that reaches a place inside the forest and below its crowns.
  /// Andrews 2012 (USDA RMRS-GTR-266), wind adjustment factors from Albini & Baughman 1979: 0.1 to 0.2 under
  /// closed crowns, 0.3 partly sheltered. 1: no shelter.
  double shelter_factor = 1;
  /// Distance from the forest's edge over which the shelter grows in: a canopy's height or more (Belcher,
  /// Jerram & Hunt 2003, adjustment of wind to a canopy).
  double shelter_edge_m = 10;
};

template <typename Visitor>
void visit_fields(Visitor& visit, WindConfig& config) {
  visit("reference_height_m", config.reference_height_m, 3.0, 100.0);
  visit("roughness_m", config.roughness_m, 0.0, 2.0);
  visit("turbulence_wind20_mps", config.turbulence_wind20_mps, 0.0, 50.0);
  visit("gust", config.gust);
  visit("shelter_factor", config.shelter_factor, 0.0, 1.0);
  visit("shelter_edge_m", config.shelter_edge_m, 0.1, 100.0);
}

/// Where the forest stands, and so where its shelter is. Nowhere by default.
struct ForestStand {
  double from_x_m = 0;
  double to_x_m = 0;
  double half_width_m = 0;  ///< |y|
  double canopy_top_m = 0;
};

/// The air along one flight: mean wind with shear, turbulence, one gust, shelter.
class Wind {
 public:
  /// Steady and the same everywhere.
  explicit Wind(const Eigen::Vector3d& mean_world_mps);
  /// The mean is that at the reference height. Turbulence draws from `seed`, and only where it is on.
  Wind(const Eigen::Vector3d& mean_world_mps, const WindConfig& config, const ForestStand& stand,
       std::uint64_t seed);

  /// One step of the aircraft's way through the air, ending at `t_ns`.
  void advance(std::int64_t t_ns, double step_s, const Eigen::Vector3d& position_world,
               const Eigen::Vector3d& velocity_world_mps);

  /// The wind now. Only where the aircraft is does it have a meaning: turbulence and gust are known along the
  /// flight alone.
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
