#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/report/line_plot.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {

/// The results of the flights of one condition. Flights that failed to run count in `failed_to_run` alone.
struct ConditionSummary {
  std::string condition;
  int flown = 0;
  int goals = 0;
  int collision = 0, ground = 0, out_of_bounds = 0, time = 0;  ///< the other outcomes
  int failed_to_run = 0;
  int crashes() const { return collision + ground + out_of_bounds; }
  double among_obstacles_km = 0;  ///< of all flown
  Interval success;               ///< 95 %, Wilson's
  double mean_speed_mps = 0;      ///< mean over flights; NaN without any, as the next
  double position_error_mean_m = 0;
  std::int64_t obstacle_ahead = 0;  ///< replans
  std::int64_t obstacle_ahead_ompl = 0;
  SurvivalCurve survival;  ///< over true progress, m
};

/// Of rows of one condition or of several.
ConditionSummary summary_of(const std::vector<FlightRow>& rows);

/// Kilometres flown among obstacles between crashes, with their exact 95 % interval. Every end but goal and
/// time is a crash. Without a crash the value is the interval's lower end, and its upper end infinite.
struct CrashDistance {
  double value_km = 0;
  Interval interval;
  /// NaN where the value is a bound: plots draw no dot there.
  double measured_km() const { return std::isfinite(interval.maximum) ? value_km : NAN; }
};
CrashDistance crash_distance(const ConditionSummary& summary);
/// "1.2 (0.6 to 2.8)"; "> 4.0" without a crash; "-" where nothing was flown among obstacles.
std::string crash_distance_text(const ConditionSummary& summary);

/// A summary per condition, in order of appearance.
std::vector<ConditionSummary> summarise(const std::vector<FlightRow>& rows);

/// A row per condition; to_text or to_markdown prints it. `median m`: the distance by which half the flights
/// have ended, "> 75" where more than half got that far; `km`: flown among obstacles; `km/crash`:
/// crash_distance_text(); `OMPL %`: share of the replans with an obstacle ahead that use a manoeuvre that
/// OMPL found.
Table summary_table(const std::vector<ConditionSummary>& summaries);

// Plots take a row's scenario, overrides and grid from its condition, or the condition's name alone.

/// What conditions may differ in: a column of a row, or a numeric key of a campaign's grid.
struct PlotAxis {
  std::function<double(const FlightRow&)> value;
  std::string key, name, label;
};

/// Cruise speed (m/s), trees per hectare, and every other key of the grid whose values are numbers.
std::vector<PlotAxis> axes_of(const std::vector<Condition>& conditions);

/// Share of flights that reached the goal, with 95 % Wilson bars, over the axis. Conditions that differ in
/// nothing else form a series, joined by a line. Points are set a little apart sideways where series share a
/// value.
LinePlot success_over(const std::vector<FlightRow>& rows, const std::vector<Condition>& conditions,
                      const PlotAxis& axis);
/// The same of the kilometres between crashes. Without a crash there is no dot, but an arrow from the bound
/// up.
LinePlot crash_distance_over(const std::vector<FlightRow>& rows, const std::vector<Condition>& conditions,
                             const PlotAxis& axis);

/// The same side by side: a place per condition, with its name.
LinePlot success_by_condition(const std::vector<FlightRow>& rows, const std::vector<Condition>& conditions);
LinePlot crash_distance_by_condition(const std::vector<FlightRow>& rows,
                                     const std::vector<Condition>& conditions);

/// Share of flights that get beyond each distance (m of progress): Kaplan and Meier's steps with 95 % bands,
/// at most six conditions to a panel; of more than six, those of one scenario, which the title names.
std::vector<LinePlot> survival_curves(const std::vector<FlightRow>& rows,
                                      const std::vector<Condition>& conditions);

/// One SVG: success over each axis, and for courses of over 100 m the kilometres between crashes, each if
/// conditions differ in nothing else, or else by condition; then survival. Flights that failed to run are
/// left out. Empty if none was flown.
std::string campaign_svg(const std::vector<FlightRow>& rows, const std::vector<Condition>& conditions);

}  // namespace understory
