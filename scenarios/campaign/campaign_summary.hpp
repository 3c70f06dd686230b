#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/statistics/survival.hpp"

namespace understory {

/// What the flights of one condition came to. Flights that failed to run enter nothing but `failed_to_run`.
struct ConditionSummary {
  std::string condition;
  int flown = 0;
  int goals = 0;
  int collision = 0, ground = 0, out_of_bounds = 0, time = 0;  ///< the other endings
  int failed_to_run = 0;
  Interval success;           ///< 95 %, Wilson's
  double mean_speed_mps = 0;  ///< mean over flights; NaN without any, as the next
  double position_error_mean_m = 0;
  std::int64_t obstacle_ahead = 0;  ///< replans
  std::int64_t obstacle_ahead_ompl = 0;
  SurvivalCurve survival;  ///< over true progress, m
};

/// The distance that a flight says something about, in m of progress: to its end, or, censored, to its goal.
Lifetime lifetime_of(const FlightRow& row);

/// The rows of each condition, conditions in order of appearance.
std::vector<std::vector<FlightRow>> rows_by_condition(const std::vector<FlightRow>& rows);

/// A summary per condition, in order of appearance.
std::vector<ConditionSummary> summarise(const std::vector<FlightRow>& rows);

/// A row per condition; to_text or to_markdown prints it. `median m`: the distance by which half the flights
/// have ended, "> 75" where more than half got that far; `OMPL %`: replans with an obstacle ahead flown on
/// OMPL's answer.
Table summary_table(const std::vector<ConditionSummary>& summaries);

}  // namespace understory
