#pragma once

#include <filesystem>

#include "scenarios/flight/flight_log.hpp"

namespace understory {

/// Writes trajectory.csv, truth.tum, estimate.tum, map.ply, obstacles.csv, flight.log and result.json into
/// `folder`, each whole or not at all, result.json last.
void write_run_files(const FlightLog& log, const std::filesystem::path& folder);

}  // namespace understory
