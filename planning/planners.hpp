#pragma once

#include <memory>

#include "planning/planner.hpp"

namespace understory {

/// Uses a library of manoeuvres made before the flight (after Barry, Florence & Tedrake 2018). Flies straight
/// on if that is safe; else the manoeuvre in force if that is safe; else the manoeuvre with the largest
/// clearance.
std::unique_ptr<Planner> library_planner(const PlannerContext& context,
                                         const ManoeuvreLibraryConfig& library);

/// Straight on towards the goal at the cruise altitude, through everything: the baseline that any planner
/// must beat.
std::unique_ptr<Planner> straight_planner(const PlannerContext& context);

}  // namespace understory
