#pragma once

#include <cstdint>
#include <optional>

#include "planning/autopilot_config.hpp"
#include "planning/manoeuvre.hpp"

namespace understory {

/// The cheapest manoeuvre found whose rollout reaches the horizon without touching an obstacle, or nothing.
/// Some commands are drawn near those of `hint`, the plan in force (may be empty). Repeats exactly for equal
/// arguments, whatever was searched before: `seed` seeds every generator of the search.
std::optional<Manoeuvre> search_manoeuvre(const FlightTask& task, const FlightState& start,
                                          const Manoeuvre& hint, const ManoeuvreSearchConfig& config,
                                          std::uint64_t seed);

}  // namespace understory
