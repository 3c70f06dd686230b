#pragma once

#include <cstdint>
#include <optional>

#include "planning/manoeuvre.hpp"

namespace understory {

/// The tree of manoeuvres that OMPL grows (SST, Li, Littlefield & Bekris 2016, in the space of bank and climb
/// commands over time).
struct ManoeuvreSearchConfig {
  int iterations = 600;            ///< extensions tried; never a time, so that runs repeat
  double maximum_bank_rad = 1.57;  ///< a wing on edge passes where a level one does not
  double minimum_climb_mps = -1.5;
  double maximum_climb_mps = 2.0;
  double minimum_part_s = 0.08;
  double maximum_part_s = 0.48;
  int maximum_parts = 4;          ///< commands in a row before the course guidance takes over
  double hint_share = 0.3;        ///< of the commands tried: near those of the plan in force
  double extreme_share = 0.2;     ///< of the commands tried: with the maximum bank, to either side
  double selection_radius = 0.6;  ///< SST's, in the search's metric (see manoeuvre_search.cpp)
  double pruning_radius = 0.15;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ManoeuvreSearchConfig& config) {
  visit("iterations", config.iterations, 1, 100000);
  visit("maximum_bank_rad", config.maximum_bank_rad, 0.1, 1.6);
  visit("minimum_climb_mps", config.minimum_climb_mps, -6.0, 0.0);
  visit("maximum_climb_mps", config.maximum_climb_mps, 0.0, 6.0);
  visit("minimum_part_s", config.minimum_part_s, 0.02, 1.0);
  visit("maximum_part_s", config.maximum_part_s, 0.02, 4.0);
  visit("maximum_parts", config.maximum_parts, 1, 6);
  visit("hint_share", config.hint_share, 0.0, 1.0);
  visit("extreme_share", config.extreme_share, 0.0, 1.0);
  visit("selection_radius", config.selection_radius, 0.0, 10.0);
  visit("pruning_radius", config.pruning_radius, 0.0, 10.0);
}

/// The cheapest manoeuvre found whose rollout reaches the horizon without touching an obstacle, or nothing.
/// Some commands are drawn near those of `hint`, the plan in force (may be empty). Repeats exactly for equal
/// arguments, whatever was searched before: `seed` seeds every generator of the search.
std::optional<Manoeuvre> search_manoeuvre(const FlightTask& task, const FlightState& start,
                                          const Manoeuvre& hint, const ManoeuvreSearchConfig& config,
                                          std::uint64_t seed);

}  // namespace understory
