#include "scenarios/tuning/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/tuning/race.hpp"

namespace understory {
namespace {

/// Nothing of those that were dropped, nor of the scenario as it is, which stands beside the search.
std::vector<Figures> figures_to_choose_from(const std::vector<Trial>& trials) {
  std::vector<Figures> figures;
  for (const Trial& trial : trials)
    figures.push_back(trial.dropped || trial.number == 0 ? Figures() : trial.figures);
  return figures;
}

/// One tuning while it goes on.
class Tuning {
 public:
  Tuning(const TuneFile& file, const TuneOptions& options) : file_(file), options_(options) {}

  /// A log of what `judge` says of points; with `race`, most of them are dropped after a glance.
  TrialLog log(const std::string& part, Judge& judge, const Race* race = nullptr) {
    return TrialLog(options_.folder / (part + ".jsonl"), keys_of(file_.space), file_.figures,
                    [this, part, &judge, race](int number, const Point& point) {
                      if (race == nullptr) return trial_of(measure(part, number, point, judge), judge);
                      const Measured glance = glance_at(part, number, point, judge);
                      if (!glance.refused.empty()) return trial_of(glance, judge);
                      const std::optional<Figures> figures =
                          number > 0 ? race->dropped(glance.units) : std::nullopt;
                      if (!figures) return trial_of(measure(part, number, point, judge), judge);
                      Trial trial;
                      trial.figures = *figures;
                      trial.dropped = true;
                      return trial;
                    });
  }
  /// Measured anew where a search goes on: the logs hold no units.
  const Measured& glance_at(const std::string& part, int number, const Point& point, Judge& judge) {
    const auto held = glances_.find(point);
    if (held != glances_.end()) return held->second;
    return glances_[point] = measure(part, number, point, judge, Look::glance);
  }

  Measured measure(const std::string& part, int number, const Point& point, Judge& judge,
                   Look look = Look::whole) {
    if (options_.stop_asked()) throw Stopped{};
    ++progress_.measured;
    return measure_at(point, file_, judge, fmt::format("{}-{}", part, number), look);
  }

  /// `after`: what is still to be measured when this part is done, as far as known.
  void report(const std::string& part, std::size_t done, std::size_t of, std::size_t after) {
    progress_.part = part;
    progress_.done = done;
    progress_.of = of;
    progress_.left = of - done + after;
    options_.on_progress(progress_);
  }
  void set_best(double figure) { progress_.best = figure; }

 private:
  static Trial trial_of(const Measured& measured, const Judge& judge) {
    Trial trial;
    trial.refused = measured.refused;
    if (measured.refused.empty()) trial.figures = judge.figures(measured.units);
    return trial;
  }

  const TuneFile& file_;
  const TuneOptions& options_;
  std::map<Point, Measured> glances_;
  TuneProgress progress_;
};

std::size_t sensitivity_trials(const TuneFile& file) {
  return static_cast<std::size_t>(file.search.sensitivity_points + 1) * file.space.parameters.size();
}

/// All trials: the scenario as it is, then the search's.
std::vector<Trial> run_search(const TuneFile& file, Tuning& tuning, Judge& training) {
  const Race::GlanceAt glance_at = [&](const Trial& trial) -> const std::vector<Counts>& {
    return tuning.glance_at("trials", trial.number, trial.point, training).units;
  };
  Race race(file.objective, training, glance_at);
  TrialLog log = tuning.log("trials", training, &race);
  double minimum = std::numeric_limits<double>::infinity();
  const auto of = static_cast<std::size_t>(file.search.trials);
  const auto evaluate = [&](const Point& point) {
    const Trial trial = log.evaluate(point);
    if (!trial.dropped && !trial.figures.empty()) {
      race.add(trial);
      const double cost = fitness(file.objective, trial.figures).front();
      if (cost < minimum) tuning.set_best(trial.figures[file.objective.goals.front().figure]);
      minimum = std::min(minimum, cost);
    }
    tuning.report("trial", log.evaluated().size() - 1, of, maximum_front / 2 + sensitivity_trials(file));
    return trial.figures;
  };
  evaluate(file.scenario_point);
  search(file.space, file.objective, file.search, evaluate);
  log.finish();
  return log.evaluated();
}

/// The search's best, numbered as in `trials`; where none keeps the limits, the one that misses them least.
std::size_t choose_best(const TuneFile& file, const std::vector<Trial>& trials,
                        const std::filesystem::path& folder, bool& keeps_limits) {
  const std::vector<Figures> figures = figures_to_choose_from(trials);
  if (const auto best = best_of(file.objective, figures)) {
    keeps_limits = true;
    return *best;
  }
  if (std::ranges::any_of(trials, &Trial::dropped) &&
      std::ranges::all_of(figures, [](const Figures& some) { return some.empty(); })) {
    keeps_limits = violation(file.objective, trials.front().figures) == 0;  // nothing comes near the scenario
    return 0;
  }
  keeps_limits = false;
  const auto cost = [&](const Figures& some) { return fitness(file.objective, some).front(); };
  const auto minimum = std::ranges::min_element(figures, {}, cost);
  if (minimum->empty())
    throw ScenarioError(fmt::format("{}: no trial could be measured, all were refused; the last: {}",
                                    (folder / "trials.jsonl").string(), trials.back().refused));
  return static_cast<std::size_t>(minimum - figures.begin());
}

std::vector<std::size_t> choose_front(const TuneFile& file, const std::vector<Trial>& trials) {
  std::vector<Figures> figures = figures_to_choose_from(trials);
  figures.front() = trials.front().figures;  // the scenario as it is may be on it
  return thinned(pareto_front(file.objective, figures), maximum_front);
}

/// The values of each parameter alone: spread over its range, and the best's own.
std::vector<Sensitivity> values_to_vary(const TuneFile& file, const Point& best) {
  std::vector<Sensitivity> all;
  for (std::size_t i = 0; i < best.size(); ++i) {
    Sensitivity one;
    one.values = spread_values(file.space.parameters[i], file.search.sensitivity_points);
    if (std::ranges::find(one.values, best[i]) == one.values.end()) one.values.push_back(best[i]);
    std::ranges::sort(one.values);
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<Sensitivity> vary(const TuneFile& file, Tuning& tuning, Judge& training, const Point& best) {
  TrialLog log = tuning.log("sensitivity", training);
  std::vector<Sensitivity> all = values_to_vary(file, best);
  std::size_t of = 0;
  for (const Sensitivity& one : all) of += one.values.size();
  for (std::size_t i = 0; i < best.size(); ++i)
    for (const double value : all[i].values) {
      Point point = best;
      point[i] = value;
      all[i].figures.push_back(log.evaluate(point).figures);
      tuning.report("sensitivity", log.evaluated().size(), of, 0);
    }
  return all;
}

/// Nobody should tune for detections that no flight needs.
std::vector<FlownTrial> fly_best(const Tuned& tuned, Tuning& tuning, Judge& flights) {
  std::vector<FlownTrial> flown{{"as it is", tuned.scenario.training, {}},
                                {"tuned", tuned.best.training, {}}};
  if (!tuned.front.empty())
    for (const JudgedTrial* end : {&tuned.front.front(), &tuned.front.back()})
      if (std::ranges::none_of(flown,
                               [&](const FlownTrial& one) { return one.trial.point == end->training.point; }))
        flown.push_back({"end of the front", end->training, {}});
  for (std::size_t i = 0; i < flown.size(); ++i) {
    flown[i].flights = tuning.measure("flight", flown[i].trial.number, flown[i].trial.point, flights).units;
    tuning.report("flying", i + 1, flown.size(), 0);
  }
  return flown;
}

std::vector<Counts> drawn(const std::vector<Counts>& units, std::span<const double> places) {
  std::vector<Counts> some;
  for (const double place : places) some.push_back(units[static_cast<std::size_t>(place)]);
  return some;
}

std::vector<FigureChange> changes_on(const TuneFile& file, const Tuned& tuned, const Judge& validation) {
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
      changes.back().interval =
          paired_difference_interval(paired_goals(tuned.scenario_units, tuned.best_units));
  }
  return changes;
}

}  // namespace

Tuned tune(const TuneFile& file, Judge& training, Judge& validation, const TuneOptions& options,
           Judge* flights) {
  Tuning tuning(file, options);
  Tuned tuned;
  tuned.trials = run_search(file, tuning, training);
  const std::size_t best = choose_best(file, tuned.trials, options.folder, tuned.keeps_limits);
  const std::vector<std::size_t> front = choose_front(file, tuned.trials);

  TrialLog log = tuning.log("validation", validation);
  const auto validated = [&](std::size_t number) {
    JudgedTrial judged{tuned.trials[number], log.evaluate(tuned.trials[number].point)};
    tuning.report("validation", log.evaluated().size(), front.size() + 2, sensitivity_trials(file));
    return judged;
  };
  tuned.scenario = validated(0);
  tuned.best = validated(best);
  for (const std::size_t number : front) tuned.front.push_back(validated(number));
  tuned.sensitivity = vary(file, tuning, training, tuned.best.training.point);
  tuned.scenario_units = tuning.measure("validation", 0, tuned.scenario.training.point, validation).units;
  tuned.best_units = tuning.measure("validation", 1, tuned.best.training.point, validation).units;
  tuned.changes = changes_on(file, tuned, validation);
  if (flights != nullptr) tuned.flown = fly_best(tuned, tuning, *flights);
  return tuned;
}

Measured measure_at(const Point& point, const TuneFile& file, Judge& judge, const std::string& name,
                    Look look) {
  Scenario scenario;
  try {
    const std::string text = to_yaml(file.space, point);
    scenario = load_changed_scenario(file.scenario_file, {parse_yaml(text, "trial")});
  } catch (const ScenarioError& error) {  // keys that contradict each other
    return {{}, error.what()};
  }
  return judge.measure(name, scenario, look);
}

PairedOutcomes paired_goals(const std::vector<Counts>& before, const std::vector<Counts>& after) {
  PairedOutcomes goals;
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
    goals.count(before[i].front() > 0, after[i].front() > 0);
  return goals;
}

}  // namespace understory
