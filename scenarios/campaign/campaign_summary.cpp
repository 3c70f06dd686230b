#include "scenarios/campaign/campaign_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

/// The distance over which a flight was observed, in m of progress: to its end, or, censored, to its goal, or
/// to where its time was over and it still flew.
Lifetime lifetime_of(const FlightRow& row) {
  if (row.reached_goal()) return {row.goal_m, false};
  return {std::max(row.progress_m, 0.0), row.outcome != "time"};
}

std::string success_text(const ConditionSummary& summary) {
  if (summary.flown == 0) return "-";
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", 100.0 * summary.goals / summary.flown,
                     100 * summary.success.minimum, 100 * summary.success.maximum);
}

std::string median_text(const ConditionSummary& summary) {
  if (summary.flown == 0) return "-";
  const std::optional<double> median = median_survival(summary.survival);
  return median ? number_text(*median, 1) : fmt::format("> {:.0f}", summary.survival.last_at);
}

std::string ompl_text(const ConditionSummary& summary) {
  if (summary.obstacle_ahead == 0) return "-";
  return fmt::format("{:.1f}", 100.0 * static_cast<double>(summary.obstacle_ahead_ompl) /
                                   static_cast<double>(summary.obstacle_ahead));
}

/// The rows of each condition, conditions in order of appearance.
std::vector<std::vector<FlightRow>> rows_by_condition(const std::vector<FlightRow>& rows) {
  std::vector<std::vector<FlightRow>> groups;
  for (const FlightRow& row : rows) {
    const auto same = std::ranges::find_if(groups, [&](const std::vector<FlightRow>& group) {
      return group.front().condition == row.condition;
    });
    if (same == groups.end())
      groups.push_back({row});
    else
      same->push_back(row);
  }
  return groups;
}

}  // namespace

ConditionSummary summary_of(const std::vector<FlightRow>& rows) {
  ConditionSummary summary;
  summary.condition = rows.front().condition;
  std::vector<double> speeds_mps, errors_m;
  std::vector<Lifetime> lifetimes;
  const auto count = [&](const char* outcome) {
    return static_cast<int>(std::ranges::count_if(
        rows, [&](const FlightRow& row) { return row.flown() && row.outcome == outcome; }));
  };
  for (const FlightRow& row : rows) {
    if (!row.flown()) continue;
    speeds_mps.push_back(row.mean_speed_mps);
    errors_m.push_back(row.position_error_mean_m);
    summary.among_obstacles_km += 1e-3 * row.among_obstacles_m;
    lifetimes.push_back(lifetime_of(row));
    summary.obstacle_ahead += row.planner.obstacle_ahead;
    summary.obstacle_ahead_ompl += row.planner.obstacle_ahead_ompl;
  }
  summary.flown = static_cast<int>(lifetimes.size());
  summary.failed_to_run = static_cast<int>(rows.size()) - summary.flown;
  summary.goals = count("goal");
  summary.collision = count("collision");
  summary.ground = count("ground");
  summary.out_of_bounds = count("out_of_bounds");
  summary.time = count("time");
  summary.success = wilson_interval(summary.goals, summary.flown);
  summary.mean_speed_mps = mean_of(speeds_mps);
  summary.position_error_mean_m = mean_of(errors_m);
  summary.survival = kaplan_meier(lifetimes);
  return summary;
}

CrashDistance crash_distance(const ConditionSummary& summary) {
  const int crashes = summary.crashes();
  const Interval count = poisson_interval(crashes);
  const Interval interval{summary.among_obstacles_km / count.maximum,
                          summary.among_obstacles_km / count.minimum};
  return {crashes > 0 ? summary.among_obstacles_km / crashes : interval.minimum, interval};
}

std::string crash_distance_text(const ConditionSummary& summary) {
  const auto [value_km, interval] = crash_distance(summary);
  if (summary.among_obstacles_km == 0) return "-";
  const auto text = [](double km) {
    return km < 0.1 ? fmt::format("{:.2g}", km) : fmt::format("{:.{}f}", km, km < 1 ? 2 : km < 10 ? 1 : 0);
  };
  if (!std::isfinite(interval.maximum)) return "> " + text(value_km);
  return fmt::format("{} ({} to {})", text(value_km), text(interval.minimum), text(interval.maximum));
}

std::vector<ConditionSummary> summarise(const std::vector<FlightRow>& rows) {
  std::vector<ConditionSummary> summaries;
  for (const std::vector<FlightRow>& group : rows_by_condition(rows)) summaries.push_back(summary_of(group));
  return summaries;
}

Table summary_table(const std::vector<ConditionSummary>& summaries) {
  Table table{{"condition", "flown", "goal", "success % (95 %)", "collision", "ground", "bounds", "time",
               "m/s", "median m", "km", "km/crash (95 %)", "error m", "OMPL %", "not flown"},
              {}};
  for (const ConditionSummary& summary : summaries)
    table.add(summary.condition, summary.flown, summary.goals, success_text(summary), summary.collision,
              summary.ground, summary.out_of_bounds, summary.time, number_text(summary.mean_speed_mps, 2),
              median_text(summary), number_text(summary.among_obstacles_km, 2), crash_distance_text(summary),
              number_text(summary.position_error_mean_m, 2), ompl_text(summary), summary.failed_to_run);
  return table;
}

}  // namespace understory
