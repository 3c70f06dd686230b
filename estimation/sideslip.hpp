#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <utility>

#include "estimation/error_state.hpp"

namespace understory {

enum class SideslipModel {
  lateral_force,  ///< from the winglets' side force
  zero,           ///< v_y = 0, the original's: false by up to 2.6 m/s in dodges (docs/sources.md [15])
  off,
};

/// Sideslip from lateral specific force. Only the winglets push sideways. As flat plates with a total area S
/// their force is normal to them: rho/2 V^2 S 2 sin(beta), with V and sin(beta) = v/V of the air in the
/// body's x-y plane at the winglets. So a_y = -k V v with k = rho S / m (docs/sources.md [3]: identified
/// flat-plate model).
struct SideslipConfig {
  SideslipModel model = SideslipModel::lateral_force;
  double air_density_kgpm3 = 1.204;    ///< kg/m^3, 0.1..2
  double winglets_area_m2 = 0.038882;  ///< m^2, 1e-4..2: both together (docs/sources.md [3]: 2 x 0.019441)
  double mass_kg = 0.648412;           ///< kg, 0.05..20
  Eigen::Vector3d winglets_body_m{-0.08, 0.0,
                                  0.081954};  ///< m, -5..5: mean position (y cancels between the two)
  double sigma_mps2 = 0.2;                    ///< m/s^2, 0.01..50: noise 0.05, and what the plates leave out
  double model_error = 0.15;  ///< fraction of the force, 0..1 (docs/sources.md [15]: 15 % costs about 0.16 m)
  double zero_sigma_mps =
      2.236;  ///< m/s, 0.01..50: of v_y = 0, where that is the model (the original's variance 5)
};

template <typename Visitor>
void visit_fields(Visitor& visit, SideslipConfig& config) {
  visit("model", config.model,
        std::array<std::pair<std::string_view, SideslipModel>, 3>{
            {{"lateral_force", SideslipModel::lateral_force},
             {"zero", SideslipModel::zero},
             {"off", SideslipModel::off}}});
  visit("air_density_kgpm3", config.air_density_kgpm3, 0.1, 2.0);
  visit("winglets_area_m2", config.winglets_area_m2, 1e-4, 2.0);
  visit("mass_kg", config.mass_kg, 0.05, 20.0);
  visit("winglets_body_m", config.winglets_body_m, -5.0, 5.0);
  visit("sigma_mps2", config.sigma_mps2, 0.01, 50.0);
  visit("model_error", config.model_error, 0.0, 1.0);
  visit("zero_sigma_mps", config.zero_sigma_mps, 0.01, 50.0);
}

/// `lateral_mps2` is the accelerometer's y. Precondition: config.model is not `off`, the airspeed is not
/// zero.
Measurement<1> sideslip(const State& state, double lateral_mps2, const SideslipConfig& config,
                        FilterModel model);

}  // namespace understory
