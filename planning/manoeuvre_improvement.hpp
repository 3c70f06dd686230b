#pragma once

#include <cstdint>

#include "planning/manoeuvre.hpp"

namespace understory {

/// Random descent around a manoeuvre. A tree of random commands finds a way, but seldom its best version.
struct ManoeuvreImprovementConfig {
  int iterations = 60;           ///< rollouts tried
  double bank_sigma_rad = 0.35;  ///< of the change to one part's bank
  double climb_sigma_mps = 0.6;
  double duration_sigma_s = 0.08;
  double maximum_bank_rad = 1.57;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ManoeuvreImprovementConfig& config) {
  visit("iterations", config.iterations, 0, 100000);
  visit("bank_sigma_rad", config.bank_sigma_rad, 0.0, 3.0);
  visit("climb_sigma_mps", config.climb_sigma_mps, 0.0, 5.0);
  visit("duration_sigma_s", config.duration_sigma_s, 0.0, 1.0);
  visit("maximum_bank_rad", config.maximum_bank_rad, 0.1, 1.6);
}

struct ImprovedManoeuvre {
  Manoeuvre manoeuvre;
  double cost = 0;  ///< of its rollout; infinite where that does not reach the horizon
};

/// The cheapest variant found that reaches the horizon with `minimum_clearance_m`; `manoeuvre` itself where
/// no variant is cheaper or reaches the horizon. Repeats exactly for equal arguments.
ImprovedManoeuvre improve_manoeuvre(const FlightTask& task, const FlightState& start,
                                    const Manoeuvre& manoeuvre, double minimum_clearance_m,
                                    const ManoeuvreImprovementConfig& config, std::uint64_t seed);

}  // namespace understory
