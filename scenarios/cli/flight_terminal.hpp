#pragma once

#include <filesystem>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/progress_line.hpp"

namespace understory {

void show(ProgressLine& line, const FlightProgress& progress);

/// Throws ScenarioError where the scenario's rig is neither a name in `rigs` nor a file: here, where it is
/// still known which line named it.
void require_rig(const Scenario& scenario, const ScenarioArguments& arguments,
                 const std::filesystem::path& rigs);

}  // namespace understory
