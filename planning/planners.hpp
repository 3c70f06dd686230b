#pragma once

#include <memory>

#include "planning/planner.hpp"

namespace understory {

/// A library of manoeuvres made before the flight, of which the one with the largest clearance is flown
/// (after Barry, Florence & Tedrake 2018). Straight on where that is safe; else the manoeuvre in force, as
/// long as that is safe.
std::unique_ptr<Planner> library_planner(const PlannerContext& context,
                                         const ManoeuvreLibraryConfig& library);

/// Straight on towards the goal at the cruise altitude, through everything: the least that any planner must
/// improve on.
std::unique_ptr<Planner> straight_planner(const PlannerContext& context);

}  // namespace understory
