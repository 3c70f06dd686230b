#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "perception/io/text_table.hpp"
#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

/// Rows before they are drawn: those of each x.
struct RowSeries {
  std::string name;
  std::map<double, std::vector<FlightRow>> at;
};

/// Of a key of the grid whose values are all numbers; nothing where one is none.
std::optional<PlotAxis> axis_of(const std::string& key, const std::vector<Condition>& conditions) {
  std::map<std::string, double> values;
  for (const Condition& condition : conditions)
    for (const auto& [own, value] : condition.grid) {
      if (own != key) continue;
      const auto number = number_in<double>(value);
      if (!number) return std::nullopt;
      values[condition.name] = *number;
    }
  const auto value_of = [values](const FlightRow& row) {
    const auto found = values.find(row.condition);
    return found == values.end() ? 0 : found->second;
  };
  return PlotAxis{value_of, key, short_key(key), key};
}

constexpr AxisRange percent_range{-2, 102};  // dots at 0 and at 100 are whole

std::vector<FlightRow> flown_ones(const std::vector<FlightRow>& rows) {
  std::vector<FlightRow> flown;
  std::ranges::copy_if(rows, std::back_inserter(flown), &FlightRow::flown);
  return flown;
}

using Conditions = std::vector<Condition>;

/// Rows of a campaign whose description is not known belong to a scenario of their condition's name.
Condition condition_of(const std::string& name, const Conditions& conditions) {
  const auto found = std::ranges::find(conditions, name, &Condition::name);
  return found == conditions.end() ? Condition{name, "", name, "", {}} : *found;
}

std::vector<RowSeries> series_of(const std::vector<FlightRow>& rows, const Conditions& conditions,
                                 const PlotAxis& axis, const std::string& titled_scenario) {
  std::vector<RowSeries> all;
  for (const FlightRow& row : rows) {
    const std::string name = words_of(condition_of(row.condition, conditions), titled_scenario, axis.key);
    auto series = std::ranges::find(all, name, &RowSeries::name);
    if (series == all.end()) series = all.insert(all.end(), {name, {}});
    series->at[axis.value(row)].push_back(row);
  }
  return all;
}

void add_success(Series& series, double x, const ConditionSummary& summary) {
  series.add(x, 100.0 * summary.goals / summary.flown, 100 * summary.success.minimum,
             100 * summary.success.maximum);
}

void add_crash_distance(Series& series, double x, const ConditionSummary& summary) {
  const CrashDistance distance = crash_distance(summary);
  series.add(x, distance.measured_km(), distance.interval.minimum, distance.interval.maximum);
}

std::string scenario_of_rows(const std::vector<FlightRow>& rows, const Conditions& conditions) {
  Conditions flown;
  for (const FlightRow& row : rows) flown.push_back(condition_of(row.condition, conditions));
  return scenario_of_all(flown);
}

std::string titled(const std::string& scenario, const std::string& title) {
  return (scenario.empty() ? "" : scenario + ": ") + title;
}

LinePlot success_plot(const std::string& title, const std::string& x_label) {
  return {.title = title,
          .x_label = x_label,
          .y_label = "goal reached (%), 95 % Wilson",
          .y_range = percent_range};
}

LinePlot crash_distance_plot(const std::string& title, const std::string& x_label) {
  return {.title = title, .x_label = x_label, .y_label = "km between crashes, 95 % Garwood", .y_log = true};
}

double span_of(const std::vector<FlightRow>& rows, const PlotAxis& axis) {
  if (rows.empty()) return 0;
  const auto by_value = [&](const FlightRow& a, const FlightRow& b) { return axis.value(a) < axis.value(b); };
  const auto [minimum, maximum] = std::ranges::minmax_element(rows, by_value);
  return axis.value(*maximum) - axis.value(*minimum);
}

/// Whether any conditions differ in nothing else: scenarios that differ in much besides are no scan.
bool is_scanned(const std::vector<FlightRow>& rows, const Conditions& conditions, const PlotAxis& axis) {
  return std::ranges::any_of(series_of(rows, conditions, axis, ""),
                             [](const RowSeries& one) { return one.at.size() > 1; });
}

/// The plot with a series for the conditions that differ in nothing but the axis.
LinePlot over(const PlotAxis& axis, const std::vector<FlightRow>& all_rows, const Conditions& conditions,
              LinePlot plot, void (*add)(Series&, double, const ConditionSummary&)) {
  const std::vector<FlightRow> rows = flown_ones(all_rows);
  const std::string scenario = scenario_of_rows(rows, conditions);
  plot.title = titled(scenario, plot.title);
  const std::vector<RowSeries> all = series_of(rows, conditions, axis, scenario);
  const double apart = 0.008 * span_of(rows, axis);
  double aside = -0.5 * apart * (static_cast<double>(all.size()) - 1);
  for (const RowSeries& one : all) {
    Series series;
    series.name = one.name;
    series.mark = one.at.size() > 1 ? Mark::line_and_dots : Mark::dots;
    for (const auto& [x, its] : one.at) add(series, x + aside, summary_of(its));
    plot.series.push_back(std::move(series));
    aside += apart;
  }
  return plot;
}

/// The plot with a place for each condition.
LinePlot by_condition(const std::vector<FlightRow>& all_rows, const Conditions& conditions, LinePlot plot,
                      void (*add)(Series&, double, const ConditionSummary&)) {
  const std::vector<FlightRow> rows = flown_ones(all_rows);
  const std::string scenario = scenario_of_rows(rows, conditions);
  plot.title = titled(scenario, plot.title);
  for (const ConditionSummary& summary : summarise(rows)) {
    const auto place = static_cast<double>(plot.series.size() + 1);
    plot.x_names.emplace_back(place, words_of(condition_of(summary.condition, conditions), scenario));
    Series series;
    series.mark = Mark::dots;
    add(series, place, summary);
    plot.series.push_back(std::move(series));
  }
  plot.x_range = AxisRange{0.3, static_cast<double>(plot.series.size()) + 0.5};
  return plot;
}

/// A curve's corners: along each step, then down to the next.
Series steps_of(const ConditionSummary& summary) {
  Series series;
  series.name = summary.condition;
  series.band = true;
  const std::vector<SurvivalStep>& steps = summary.survival.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double until = i + 1 < steps.size() ? steps[i + 1].at : summary.survival.last_at;
    for (const double at : {steps[i].at, until})
      series.add(at, 100 * steps[i].share, 100 * steps[i].interval.minimum, 100 * steps[i].interval.maximum);
  }
  return series;
}

}  // namespace

std::vector<PlotAxis> axes_of(const Conditions& conditions) {
  std::vector<PlotAxis> axes{{[](const FlightRow& row) { return row.cruise_speed_mps; },
                              "autopilot.flight_model.cruise_speed_mps", "speed", "cruise speed asked (m/s)"},
                             {[](const FlightRow& row) {
                                return row.square_metres_per_tree > 0 ? 10'000 / row.square_metres_per_tree
                                                                      : 0;
                              },
                              "forest.square_metres_per_tree", "density", "trees per hectare"}};
  for (const Condition& condition : conditions)
    for (const auto& [key, value] : condition.grid)
      if (std::ranges::find(axes, key, &PlotAxis::key) == axes.end())
        if (auto axis = axis_of(key, conditions)) axes.push_back(std::move(*axis));
  return axes;
}

LinePlot success_over(const std::vector<FlightRow>& rows, const Conditions& conditions,
                      const PlotAxis& axis) {
  const LinePlot plot = success_plot(fmt::format("success over {}", axis.name), axis.label);
  return over(axis, rows, conditions, plot, add_success);
}

LinePlot crash_distance_over(const std::vector<FlightRow>& rows, const Conditions& conditions,
                             const PlotAxis& axis) {
  const LinePlot plot = crash_distance_plot(fmt::format("km/crash over {}", axis.name), axis.label);
  return over(axis, rows, conditions, plot, add_crash_distance);
}

LinePlot success_by_condition(const std::vector<FlightRow>& rows, const Conditions& conditions) {
  return by_condition(rows, conditions, success_plot("success by condition", ""), add_success);
}

LinePlot crash_distance_by_condition(const std::vector<FlightRow>& rows, const Conditions& conditions) {
  return by_condition(rows, conditions, crash_distance_plot("km/crash by condition", ""), add_crash_distance);
}

std::vector<LinePlot> survival_curves(const std::vector<FlightRow>& all_rows, const Conditions& conditions) {
  constexpr std::size_t to_a_panel = 6;
  const std::vector<FlightRow> rows = flown_ones(all_rows);
  const std::vector<ConditionSummary> all = summarise(rows);
  std::vector<LinePlot> panels;
  double furthest_m = 0;
  const bool fits_one = all.size() <= to_a_panel;
  std::string scenario;
  for (const ConditionSummary& one : all) {
    const Condition condition = condition_of(one.condition, conditions);
    const bool begins = panels.empty() || (!fits_one && condition.scenario != scenario);
    if (begins || panels.back().series.size() == to_a_panel) {
      scenario = fits_one ? scenario_of_rows(rows, conditions) : condition.scenario;
      panels.push_back({.title = titled(scenario, begins ? "survival over distance" : "survival, continued"),
                        .x_label = "progress (m)",
                        .y_label = "still flying (%), 95 %",
                        .y_range = percent_range});
    }
    panels.back().series.push_back(steps_of(one));
    panels.back().series.back().name = words_of(condition, scenario);
    furthest_m = std::max(furthest_m, one.survival.last_at);
  }
  for (LinePlot& panel : panels) panel.x_range = AxisRange{0, std::max(furthest_m, 1.0)};
  return panels;
}

std::string campaign_svg(const std::vector<FlightRow>& all_rows, const Conditions& conditions) {
  const std::vector<FlightRow> rows = flown_ones(all_rows);
  if (rows.empty()) return "";
  const bool is_long = std::ranges::any_of(rows, [](const FlightRow& row) { return row.goal_m > 100; });
  std::vector<LinePlot> panels;
  for (const PlotAxis& axis : axes_of(conditions))
    if (is_scanned(rows, conditions, axis)) {
      panels.push_back(success_over(rows, conditions, axis));
      if (is_long) panels.push_back(crash_distance_over(rows, conditions, axis));
    }
  if (panels.empty()) {
    panels.push_back(success_by_condition(rows, conditions));
    if (is_long) panels.push_back(crash_distance_by_condition(rows, conditions));
  }
  for (LinePlot& panel : survival_curves(rows, conditions)) panels.push_back(std::move(panel));
  return to_svg(panels, 2);
}

}  // namespace understory
