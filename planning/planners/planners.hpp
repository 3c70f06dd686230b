#pragma once

#include <cstdint>
#include <memory>

#include "planning/autopilot_config.hpp"
#include "planning/flight_model.hpp"
#include "planning/planner.hpp"

namespace understory {

/// What a planner is made from. None of it need outlive the making.
struct PlannerContext {
  const PlannerConfig& config;
  const FlightModel& model;
  const Mission& mission;
  std::uint64_t seed = 0;
};

/// Trees of manoeuvres grown by OMPL, each within an AvoidancePlanner. SST (Li, Littlefield & Bekris 2016)
/// prefers cheap ways while it grows.
std::unique_ptr<Planner> make_sst_planner(const PlannerContext& context);
/// RRT (LaValle & Kuffner 2001) grows from the node nearest to a drawn state, whatever it cost to get there.
std::unique_ptr<Planner> make_rrt_planner(const PlannerContext& context);
/// EST (Hsu, Latombe & Motwani 1999) grows from where few nodes are.
std::unique_ptr<Planner> make_est_planner(const PlannerContext& context);

/// A list of manoeuvres, of which the one with the greatest clearance is flown (Barry, Florence & Tedrake 2018).
std::unique_ptr<Planner> make_library_planner(const PlannerContext& context, const ManoeuvreLibraryConfig& library);

}  // namespace understory
