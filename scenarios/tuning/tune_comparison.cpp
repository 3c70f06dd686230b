#include "scenarios/tuning/tune_comparison.hpp"

#include <algorithm>
#include <numeric>

#include "scenarios/statistics/proportions.hpp"
#include "scenarios/statistics/samples.hpp"

namespace understory {
namespace {

std::vector<Counts> drawn(const std::vector<Counts>& units, std::span<const double> places) {
  std::vector<Counts> some;
  for (const double place : places) some.push_back(units[static_cast<std::size_t>(place)]);
  return some;
}

int goals_of(const std::vector<Counts>& flights) {
  return static_cast<int>(
      std::ranges::count_if(flights, [](const Counts& flight) { return flight.front() > 0; }));
}

}  // namespace

std::vector<FigureChange> changes_on_validation(const TuneFile& file, const Tuned& tuned,
                                                const Judge& validation) {
  if (tuned.scenario_units.empty() || tuned.best_units.empty()) return {};
  std::vector<double> places(tuned.best_units.size());
  std::iota(places.begin(), places.end(), 0);
  std::vector<FigureChange> changes;
  for (std::size_t i = 0; i < file.figures.size(); ++i) {
    const auto change = [&](std::span<const double> some) {
      return validation.figures(drawn(tuned.best_units, some))[i] -
             validation.figures(drawn(tuned.scenario_units, some))[i];
    };
    const BootstrapEstimate estimate = bootstrap(places, change, {.resamples = 2000});
    changes.push_back({estimate.value, estimate.interval});
    if (file.over == TuningData::flights && file.figures[i] == "success")
      changes.back().interval = paired_difference_interval(paired_goals(tuned));
  }
  return changes;
}

PairedOutcomes paired_goals(const Tuned& tuned) {
  PairedOutcomes goals;
  for (std::size_t i = 0; i < tuned.best_units.size(); ++i) {
    const bool before = tuned.scenario_units[i].front() > 0, after = tuned.best_units[i].front() > 0;
    (before ? (after ? goals.both : goals.only_first) : (after ? goals.only_second : goals.neither)) += 1;
  }
  return goals;
}

Interval success_interval(const std::vector<Counts>& flights) {
  return wilson_interval(goals_of(flights), static_cast<int>(flights.size()));
}

}  // namespace understory
