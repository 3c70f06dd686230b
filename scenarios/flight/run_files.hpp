#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/flight/flight_log.hpp"
#include "scenarios/output/output_folder.hpp"

namespace understory {

/// What a flight may leave in its folder: all names; and with the manifest of this one.
extern const std::vector<std::string> run_patterns;
FolderContents run_contents(const Scenario& scenario);

/// Writes trajectory.csv, truth.tum, estimate.tum, map.ply, obstacles.csv, flight.log and result.json into
/// `folder`, each whole or not at all, result.json last.
void write_run_files(const FlightLog& log, const std::filesystem::path& folder);

}  // namespace understory
