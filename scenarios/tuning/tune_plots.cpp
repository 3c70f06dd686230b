#include "scenarios/config/config_tree.hpp"
#include "scenarios/tuning/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace understory {
namespace {

constexpr int grayish = 4, blue = 0, orange = 1, green = 2, black = 7;  // places in the palette

double figure_or_nan(const Figures& figures, std::size_t i) {
  return figures.empty() ? std::numeric_limits<double>::quiet_NaN() : figures[i];
}

/// Where both figures are known.
void add_point(Series& series, const Trial& trial, std::size_t x, std::size_t y) {
  if (!std::isfinite(figure_or_nan(trial.figures, x)) || !std::isfinite(figure_or_nan(trial.figures, y)))
    return;
  series.x.push_back(trial.figures[x]);
  series.y.push_back(trial.figures[y]);
}

Series one_point(const char* name, int colour, const Trial& trial, std::size_t x, std::size_t y) {
  Series series{.name = name, .mark = Mark::dots, .colour = colour};
  add_point(series, trial, x, y);
  return series;
}

/// Every trial once: dots that would lie on each other are one.
Series all_trials(const Tuned& tuned, std::size_t x, std::size_t y) {
  Series series{.name = "trials (training)", .mark = Mark::dots, .colour = grayish};
  std::set<std::string> drawn;
  for (const Trial& trial : tuned.trials)
    if (!trial.figures.empty() &&
        drawn.insert(fmt::format("{:.3f} {:.3f}", trial.figures[x], trial.figures[y])).second)
      add_point(series, trial, x, y);
  return series;
}

LinePlot trials_plot(const TuneFile& file, const Tuned& tuned) {
  const std::size_t goal = file.objective.goals[0].figure;
  LinePlot plot{.title = "Trials", .x_label = "trial", .y_label = file.figures[goal]};
  Series trials{.name = "trials (training)", .mark = Mark::dots, .colour = grayish};
  Series best{.name = "best so far", .colour = blue};
  double minimum = HUGE_VAL;
  for (const Trial& trial : tuned.trials) {
    if (trial.figures.empty()) continue;
    trials.x.push_back(trial.number);
    trials.y.push_back(trial.figures[goal]);
    const double cost = fitness(file.objective, trial.figures).front();
    if (cost >= minimum) continue;
    minimum = cost;
    best.x.push_back(trial.number);
    best.y.push_back(trial.figures[goal]);
  }
  plot.series = {std::move(trials), std::move(best)};
  const auto mark = [&](const char* name, int colour, const Trial& at, const Trial& trial) {
    plot.series.push_back({.name = name,
                           .x = {static_cast<double>(at.number)},
                           .y = {figure_or_nan(trial.figures, goal)},
                           .mark = Mark::dots,
                           .colour = colour});
  };
  mark("as it is (validation)", black, tuned.scenario.training, tuned.scenario.validation);
  mark("tuned (validation)", orange, tuned.best.training, tuned.best.validation);
  return plot;
}

/// What these values span, and a little more: trials far away would press the rest into a corner.
AxisRange around(const std::vector<Series>& shown, std::vector<double> Series::*values) {
  AxisRange range{HUGE_VAL, -HUGE_VAL};
  for (const Series& series : shown)
    for (const double value : series.*values)
      if (std::isfinite(value)) range = {std::min(range.minimum, value), std::max(range.maximum, value)};
  const double margin = std::max(0.1 * (range.maximum - range.minimum), 0.005);
  return {range.minimum - margin, range.maximum + margin};
}

/// Parameters on a logarithmic scale are drawn over their logarithm.
double on_axis(const Parameter& parameter, double value) {
  return parameter.logarithmic ? std::log10(value) : value;
}

}  // namespace

LinePlot pareto_plot(const TuneFile& file, const Tuned& tuned) {
  const std::vector<std::size_t> aims = figures_of(file.objective);
  if (aims.size() < 2) return trials_plot(file, tuned);
  const std::size_t y = aims[0], x = aims[1];
  LinePlot plot{.title = "Pareto front", .x_label = file.figures[x], .y_label = file.figures[y]};
  Series training{.name = "front (training)", .mark = Mark::line_and_dots, .colour = blue};
  Series validation{.name = "the same on validation data", .mark = Mark::dots, .colour = green};
  for (const JudgedTrial& member : tuned.front) {
    add_point(training, member.training, x, y);
    add_point(validation, member.validation, x, y);
  }
  plot.series = {std::move(training), std::move(validation),
                 one_point("as it is (validation)", black, tuned.scenario.validation, x, y),
                 one_point("tuned (validation)", orange, tuned.best.validation, x, y)};
  plot.x_range = around(plot.series, &Series::x);
  plot.y_range = around(plot.series, &Series::y);
  plot.series.insert(plot.series.begin(), all_trials(tuned, x, y));
  for (const Limit& limit : file.objective.limits) {
    const std::string label = fmt::format("{} {:g}", limit.at_least ? "at least" : "at most", limit.bound);
    if (limit.figure == x) plot.references.push_back({limit.bound, label, true});
    if (limit.figure == y) plot.references.push_back({limit.bound, label, false});
  }
  return plot;
}

std::vector<LinePlot> sensitivity_plots(const TuneFile& file, const Tuned& tuned) {
  const std::vector<std::size_t> figures = figures_of(file.objective);
  std::vector<LinePlot> plots;
  for (std::size_t i = 0; i < tuned.sensitivity.size(); ++i) {
    const Parameter& parameter = file.space.parameters[i];
    const std::string name = short_key(parameter.key);
    LinePlot plot{
        .title = name, .x_label = parameter.logarithmic ? "log10 of " + name : name, .y_label = "training"};
    for (const std::size_t figure : figures) {
      Series series{.name = file.figures[figure], .mark = Mark::line_and_dots};
      for (std::size_t k = 0; k < tuned.sensitivity[i].values.size(); ++k) {
        series.x.push_back(on_axis(parameter, tuned.sensitivity[i].values[k]));
        series.y.push_back(figure_or_nan(tuned.sensitivity[i].figures[k], figure));
      }
      plot.series.push_back(std::move(series));
    }
    plot.references.push_back({on_axis(parameter, tuned.best.training.point[i]), "tuned", true});
    for (const Limit& limit : file.objective.limits)
      plot.references.push_back({limit.bound, file.figures[limit.figure], false});
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::string tune_svg(const TuneFile& file, const Tuned& tuned) {
  std::vector<LinePlot> panels{pareto_plot(file, tuned)};
  for (LinePlot& panel : sensitivity_plots(file, tuned)) panels.push_back(std::move(panel));
  return to_svg(panels, 2);
}

}  // namespace understory
