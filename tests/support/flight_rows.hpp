#pragma once

#include <fmt/format.h>

#include <string>

#include "scenarios/campaign/flight_row.hpp"

namespace understory::support {

/// A flight of a 75 m forest that ended with `outcome`, at `progress_m` (the goal's x where it got there).
inline FlightRow flown_row(const std::string& condition, std::uint64_t seed, const std::string& outcome,
                           double progress_m = 75) {
  FlightRow row;
  row.id = fmt::format("{}-{}", condition, seed);
  row.condition = condition;
  row.seed = seed;
  row.status = RunStatus::flown;
  row.outcome = outcome;
  row.cruise_speed_mps = 12;
  row.square_metres_per_tree = 49;
  row.distance_m = progress_m;
  row.progress_m = progress_m;
  row.goal_m = 75;
  row.mean_speed_mps = 11.8;
  row.minimum_clearance_m = 0.7;
  row.position_error_mean_m = 0.25;
  row.simulated_s = 6.9;
  row.digest = fmt::format("{}-{}", seed, outcome);
  return row;
}

inline FlightRow failed_row(const std::string& condition, std::uint64_t seed, const std::string& reason,
                            RunStatus status = RunStatus::crashed) {
  FlightRow row;
  row.id = fmt::format("{}-{}", condition, seed);
  row.condition = condition;
  row.seed = seed;
  row.status = status;
  row.reason = reason;
  return row;
}

}  // namespace understory::support
