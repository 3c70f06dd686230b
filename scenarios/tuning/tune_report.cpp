#include "scenarios/tuning/tune_report.hpp"
#include "scenarios/config/config_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/output/file_output.hpp"
#include "scenarios/report/sheet_page.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

std::string figure(const Trial& trial, std::size_t i) {
  return trial.figures.empty() ? "refused" : number(trial.figures[i]);
}

std::string interval_text(const Interval& interval) {
  if (!std::isfinite(interval.minimum) || !std::isfinite(interval.maximum)) return "-";
  return fmt::format("{:+.3g} to {:+.3g}", interval.minimum, interval.maximum);
}

bool keeps_limits(const TuneFile& file, const Trial& trial) {
  return violation(file.objective, trial.figures) == 0;
}

std::string objective_in_words(const TuneFile& file) {
  std::vector<std::string> words;
  for (const Goal& goal : file.objective.goals)
    words.push_back(fmt::format("{} {}", goal.maximize ? "maximum" : "minimum", file.figures[goal.figure]));
  for (const Limit& limit : file.objective.limits)
    words.push_back(fmt::format("{} {} {:g}", file.figures[limit.figure],
                                limit.at_least ? "at least" : "at most", limit.bound));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string data_in_words(const TuneFile& file) {
  if (file.over == TuningData::flights)
    return fmt::format("flights with {} training seeds ({} ...) and {} validation seeds ({} ...)",
                       file.training_seeds.size(), file.training_seeds.front(), file.validation_seeds.size(),
                       file.validation_seeds.front());
  return fmt::format("{} training and {} validation recordings", file.training_folders.size(),
                     file.validation_folders.size());
}

std::string method_name(const TuneFile& file) {
  return std::string(search_method_names[static_cast<std::size_t>(file.search.method)].first);
}

/// Of the front: both sides' figures that the objective speaks of, then the parameters.
Table front_table(const TuneFile& file, const Tuned& tuned) {
  Table table;
  table.head = {"trial"};
  for (const std::size_t i : figures_of(file.objective)) {
    table.head.push_back(file.figures[i]);
    table.head.push_back(file.figures[i] + " (training)");
  }
  for (const Parameter& parameter : file.space.parameters) table.head.push_back(short_key(parameter.key));
  for (const JudgedTrial& member : tuned.front) {
    table.rows.push_back({fmt::format("{}", member.training.number)});
    for (const std::size_t i : figures_of(file.objective)) {
      table.rows.back().push_back(figure(member.validation, i));
      table.rows.back().push_back(figure(member.training, i));
    }
    for (const double value : member.training.point) table.rows.back().push_back(fmt::format("{:g}", value));
  }
  return table;
}

/// A range whose end is best was perhaps too narrow.
std::string tuned_value(const Parameter& parameter, double value) {
  const std::vector<double> ends = spread_values(parameter, 2);
  return fmt::format("{:g}{}", value, value == ends.front() || value == ends.back() ? " (end of range)" : "");
}

Table sensitivity_table(const TuneFile& file, const Tuned& tuned) {
  const std::size_t goal = file.objective.goals.front().figure;
  Table table{
      {"parameter", "range", "the scenario's", "tuned", file.figures[goal] + " over the range", "spread"},
      {}};
  if (!file.objective.limits.empty()) table.head.push_back("bounds kept from .. to");
  for (std::size_t i = 0; i < tuned.sensitivity.size(); ++i) {
    const Sensitivity& one = tuned.sensitivity[i];
    double minimum = HUGE_VAL, maximum = -HUGE_VAL, kept_from = NAN, kept_to = NAN;
    for (std::size_t k = 0; k < one.values.size(); ++k) {
      if (one.figures[k].empty() || !std::isfinite(one.figures[k][goal])) continue;
      minimum = std::min(minimum, one.figures[k][goal]);
      maximum = std::max(maximum, one.figures[k][goal]);
      if (violation(file.objective, one.figures[k]) > 0) continue;
      if (std::isnan(kept_from)) kept_from = one.values[k];
      kept_to = one.values[k];
    }
    table.rows.push_back(
        {file.space.parameters[i].key, fmt::format("{:g} .. {:g}", one.values.front(), one.values.back()),
         fmt::format("{:g}", file.scenario_point[i]),
         tuned_value(file.space.parameters[i], tuned.best.training.point[i]),
         fmt::format("{} .. {}", number(minimum), number(maximum)), number(maximum - minimum)});
    if (!file.objective.limits.empty())
      table.rows.back().push_back(std::isnan(kept_from) ? "-"
                                                        : fmt::format("{:g} .. {:g}", kept_from, kept_to));
  }
  return table;
}

/// What the paired flights say, in a sentence.
std::string flights_sentence(const TuneFile& file, const Tuned& tuned) {
  if (file.over != TuningData::flights || tuned.scenario_units.empty() || tuned.best_units.empty()) return "";
  const PairedOutcomes goals = paired_goals(tuned.scenario_units, tuned.best_units);
  const Interval before = wilson_interval(goals.first(), goals.pairs()),
                 after = wilson_interval(goals.second(), goals.pairs());
  return fmt::format(
      "\nGoals on the validation seeds: {} of {} as it is (Wilson {:.1f} to {:.1f} %), {} tuned ({:.1f} to "
      "{:.1f} %); won {}, lost {}; McNemar's exact p {:.3g}.\n",
      goals.first(), goals.pairs(), 100 * before.minimum, 100 * before.maximum, goals.second(),
      100 * after.minimum, 100 * after.maximum, goals.only_second, goals.only_first, mcnemar_exact_p(goals));
}

/// What the best few fly.
Table flown_table(const Tuned& tuned) {
  Table table{
      {"configuration", "trial", "goals", "of", "goals, 95 %", "won", "lost", "p", "progress, %", "m/s"}};
  for (const FlownTrial& one : tuned.flown) {
    const PairedOutcomes goals = paired_goals(tuned.flown.front().flights, one.flights);
    const Interval interval = wilson_interval(goals.second(), goals.pairs());
    double progress = 0, speed_mps = 0;
    for (const Counts& flight : one.flights) progress += flight[1], speed_mps += flight[2];
    const double flights = std::max<double>(1, static_cast<double>(one.flights.size()));
    table.add(one.name, one.trial.number, goals.second(), goals.pairs(),
              fmt::format("{:.0f} to {:.0f} %", 100 * interval.minimum, 100 * interval.maximum),
              goals.only_second, goals.only_first, fmt::format("{:.2g}", mcnemar_exact_p(goals)),
              number(100 * progress / flights), number(speed_mps / flights));
  }
  return table;
}

constexpr const char* about_flown =
    "The same seeds, in pairs with the scenario as it is: won and lost seeds, McNemar's exact p.";

std::string limits_sentence(const TuneFile& file, const Tuned& tuned) {
  if (file.objective.limits.empty()) return "";
  if (!tuned.keeps_limits)
    return "\nNo trial of the search keeps the bounds: this one misses them by the smallest amount.\n";
  return keeps_limits(file, tuned.best.validation) ? "\nThe bounds are kept on validation data too.\n"
                                                   : "\nOn validation data the bounds are not kept.\n";
}

std::string gain_sentence(const TuneFile& file, const Tuned& tuned) {
  if (gains(file, tuned)) return "";
  return "\nNo trial is better than the scenario as it is, on training data: leave it so. There is no "
         "best.yaml.\n";
}

/// Of trials without figures of their own; empty if there are none.
std::string trials_sentence(const std::vector<Trial>& trials) {
  std::string text;
  const auto dropped = std::ranges::count_if(trials, &Trial::dropped);
  if (dropped > 0)
    text += fmt::format(
        "\n{} trials were dropped after a glance; trials.csv has the figures expected of them.\n", dropped);
  const auto is_refused = [](const Trial& trial) { return !trial.refused.empty(); };
  if (const auto first = std::ranges::find_if(trials, is_refused); first != trials.end())
    text += fmt::format("\n{} trials were refused, the first because of this: {}\n",
                        std::ranges::count_if(trials, is_refused), first->refused);
  return text;
}

std::string cell(const Trial& trial, std::size_t i) {
  const bool is_known = !trial.figures.empty() && std::isfinite(trial.figures[i]);
  return is_known ? fmt::format("{:.6g}", trial.figures[i]) : "";
}

/// Each trial's number and parameters, then the figures of the sides that `sides_of` gives.
template <typename Item, typename SidesOf>
Table trials_table(const TuneFile& file, const std::vector<Item>& items,
                   const std::vector<std::string>& prefixes, SidesOf&& sides_of) {
  Table table{{"trial"}};
  for (const Parameter& parameter : file.space.parameters) table.head.push_back(parameter.key);
  for (const std::string& prefix : prefixes)
    for (const std::string& figure : file.figures) table.head.push_back(prefix + figure);
  table.head.push_back("measured");
  for (const Item& item : items) {
    const std::vector<const Trial*> sides = sides_of(item);
    std::vector<std::string>& row = table.rows.emplace_back(1, fmt::format("{}", sides.front()->number));
    for (const double value : sides.front()->point) row.push_back(fmt::format("{}", value));
    for (const Trial* side : sides)
      for (std::size_t i = 0; i < file.figures.size(); ++i) row.push_back(cell(*side, i));
    const bool is_refused = !sides.front()->refused.empty();
    row.push_back(is_refused ? "refused" : sides.front()->dropped ? "glance" : "whole");
  }
  return table;
}

std::string search_in_words(const TuneFile& file, const Tuned& tuned) {
  return fmt::format(
      "{} parameters of {}, tuned for {} over {}: {} trials, {}, seed {}. Training chose trial {}; the "
      "figures that count are those of validation.",
      file.space.parameters.size(), file.scenario_file.stem().string(), objective_in_words(file),
      data_in_words(file), tuned.trials.size() - 1, method_name(file), file.search.seed,
      tuned.best.training.number);
}

/// The tuned keys as `fly --with` reads them, and the detector that they are of.
std::string tuned_config(const TuneFile& file, const JudgedTrial& trial) {
  std::string text = fmt::format("# {}: trial {} of a search for {}; over {}.\n", file.name,
                                 trial.training.number, objective_in_words(file), data_in_words(file));
  for (std::size_t i = 0; i < file.figures.size(); ++i)
    text += fmt::format("# {} {} (training {})\n", file.figures[i], figure(trial.validation, i),
                        figure(trial.training, i));
  std::string keys = to_yaml(file.space, trial.training.point);
  const std::string detector = load_changed_scenario(file.scenario_file, {}).perception.detector;
  if (file.over == TuningData::recordings && detector != "pushbroom")
    keys.replace(0, std::string_view("perception:").size(), "perception:\n  detector: " + detector);
  return text + keys;
}

}  // namespace

bool gains(const TuneFile& file, const Tuned& tuned) {
  const auto cost = [&](const JudgedTrial& trial) { return fitness(file.objective, trial.training.figures); };
  return file.objective.goals.size() > 1 || cost(tuned.best) < cost(tuned.scenario);
}

Table comparison_table(const TuneFile& file, const Tuned& tuned) {
  Table table{
      {"figure", "as it is", "tuned", "difference", "95 %", "as it is (training)", "tuned (training)"}, {}};
  for (std::size_t i = 0; i < file.figures.size(); ++i) {
    const bool is_known = i < tuned.changes.size() && std::isfinite(tuned.changes[i].difference);
    table.rows.push_back({file.figures[i], figure(tuned.scenario.validation, i),
                          figure(tuned.best.validation, i),
                          is_known ? fmt::format("{:+.3g}", tuned.changes[i].difference) : "-",
                          is_known ? interval_text(tuned.changes[i].interval) : "-",
                          figure(tuned.scenario.training, i), figure(tuned.best.training, i)});
  }
  return table;
}

std::string tune_summary(const TuneFile& file, const Tuned& tuned) {
  std::string text = fmt::format("# {}\n\n{}\n\n", file.name, search_in_words(file, tuned));
  text += to_markdown(comparison_table(file, tuned));
  text += flights_sentence(file, tuned) + limits_sentence(file, tuned) + gain_sentence(file, tuned) +
          trials_sentence(tuned.trials);
  if (tuned.best_units.size() < 15)
    text += fmt::format("\nIntervals come from {} units: below about 15 they are too narrow.\n",
                        tuned.best_units.size());
  if (!tuned.flown.empty())
    text += fmt::format("\n## In flight\n{}\n\n{}", about_flown, to_markdown(flown_table(tuned)));
  text +=
      "\n## Pareto front\nOf the training figures: no other trial of the search is better in one without "
      "being worse in another. `front/trial-N.yaml` flies each.\n\n" +
      to_markdown(front_table(file, tuned));
  text += "\n## Sensitivity\nEach parameter alone varied from the tuned ones, on training data.\n\n" +
          to_markdown(sensitivity_table(file, tuned));
  if (gains(file, tuned))
    text += "\n## Tuned keys\n```yaml\n" + to_yaml(file.space, tuned.best.training.point) + "```\n";
  return text;
}

void write_tune_report(const std::filesystem::path& folder, const TuneFile& file, const Tuned& tuned,
                       const std::filesystem::path& data_root) {
  using Sides = std::vector<const Trial*>;
  const Table trials =
      trials_table(file, tuned.trials, {""}, [](const Trial& trial) { return Sides{&trial}; });
  const Table front =
      trials_table(file, tuned.front, {"training_", "validation_"}, [](const JudgedTrial& member) {
        return Sides{&member.training, &member.validation};
      });
  write_whole_file(folder / "trials.csv", to_csv(trials));
  write_whole_file(folder / "pareto.csv", to_csv(front));
  write_whole_file(folder / "summary.md", tune_summary(file, tuned));
  write_whole_file(folder / "tune.svg", tune_svg(file, tuned));
  std::vector<SheetSection> page{
      {.title = "The scenario as it is, and tuned", .table = comparison_table(file, tuned)}};
  if (!tuned.flown.empty())
    page.push_back({.title = std::string("In flight. ") + about_flown, .table = flown_table(tuned)});
  page.push_back({.title = "Front", .plots = {pareto_plot(file, tuned)}, .table = front});
  page.push_back({.title = "Each parameter alone", .plots = sensitivity_plots(file, tuned)});
  page.push_back({.title = "Trials", .table = trials});
  write_whole_file(folder / "report.html",
                   sheet_page(data_root, "Tuning " + file.name,
                              (gains(file, tuned) ? "" : "No trial is better than the scenario as it is. ") +
                                  search_in_words(file, tuned),
                              page));
  if (gains(file, tuned)) write_whole_file(folder / "best.yaml", tuned_config(file, tuned.best));
  prepare_output_folder(folder / "front");
  for (const JudgedTrial& member : tuned.front)
    write_whole_file(folder / "front" / fmt::format("trial-{}.yaml", member.training.number),
                     tuned_config(file, member));
}

}  // namespace understory
