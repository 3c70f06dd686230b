#pragma once

#include <filesystem>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/flight/fly.hpp"

namespace understory {

/// One line of a terminal, written over at every call.
void print_flight_progress(const FlightProgress& progress);

/// Throws ScenarioError where the scenario's rig is neither a name in `rigs` nor a file: here, where it is
/// still known which line named it.
void require_rig(const Scenario& scenario, const ScenarioArguments& arguments,
                 const std::filesystem::path& rigs);

}  // namespace understory
