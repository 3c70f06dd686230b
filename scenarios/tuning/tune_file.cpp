#include "scenarios/tuning/tune_file.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/tuning/judge.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr int maximum_trials = 1'000'000;

constexpr std::array<std::pair<std::string_view, TuningData>, 2> data_names{
    {{"recordings", TuningData::recordings}, {"flights", TuningData::flights}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> scale_names{{{"linear", false}, {"log", true}}};

struct ObjectiveText {
  std::vector<std::string> maximize, minimize;
  ConfigNode at_least, at_most;
};

void visit_fields(FieldVisitor& visit, ObjectiveText& text) {
  visit("maximize", text.maximize, "a figure, or a list of such");
  visit("minimize", text.minimize, "a figure, or a list of such");
  visit("at_least", text.at_least);
  visit("at_most", text.at_most);
}

/// The file as it stands.
struct TuneText {
  std::string name, scenario;
  ConfigNode parameters;
  ObjectiveText objective;
  TuneFile tune;  ///< the keys that need no more than reading
  std::vector<std::string> training, validation, fly;
};

void visit_fields(FieldVisitor& visit, TuneText& text) {
  const std::string data = "folders of recordings, or the seeds to fly, for instance 1..200";
  visit("name", text.name);
  visit("scenario", text.scenario);
  visit("parameters", text.parameters);
  visit("objective", text.objective);
  visit("search", text.tune.search);
  visit("over", text.tune.over, data_names);
  visit("training", text.training, data);
  visit("validation", text.validation, data);
  visit("fly", text.fly, "seeds, for instance 1100..1119");
  visit("every", text.tune.every, 1, 1000);
  visit("timeout_s", text.tune.timeout_s, 1, 86400);
}

Parameter parameter_of(const ConfigNode& node, const NumericKey& key) {
  const std::string name = "parameters." + node.key;
  const std::string expected = "{from: ..., to: ..., scale: linear | log, steps: ...} or {values: [...]}";
  if (node.kind != ConfigNode::Kind::map) refuse_input(node.origin, name, "expected " + expected);
  Parameter parameter{key.key, key.whole};
  FieldNumbers from{FieldNumbers::Shape::optional, key.whole, key.minimum, key.maximum},
      to = from, values{FieldNumbers::Shape::list, key.whole, key.minimum, key.maximum};
  read_fields(
      node,
      [&](FieldVisitor& visit) {
        visit.numbers("from", from, "");
        visit.numbers("to", to, "");
        visit("scale", parameter.logarithmic, scale_names);
        visit("steps", parameter.steps, 2, 1000);
        visit.numbers("values", values, "");
      },
      name);
  if (find_child(node, "values") != nullptr) {
    const std::string origin = nearest_origin(node, "values");
    if (values.values.size() < 2 || node.children.size() > 1)
      refuse_input(origin, name + ".values", "must be a list of two values or more, without from and to");
    parameter.values = values.values;
    std::ranges::sort(parameter.values);
    if (std::ranges::adjacent_find(parameter.values) != parameter.values.end())
      refuse_input(origin, name + ".values", "all values must be different");
    return parameter;
  }
  if (from.values.empty()) refuse_input(node.origin, name + ".from", "expected " + expected);
  if (to.values.empty()) refuse_input(node.origin, name + ".to", "expected " + expected);
  parameter.from = from.values[0];
  parameter.to = to.values[0];
  if (!(parameter.from < parameter.to)) refuse_input(node.origin, name, "from must be less than to");
  if (parameter.logarithmic && parameter.from <= 0)
    refuse_input(node.origin, name, "scale: log requires from above 0");
  return parameter;
}

const NumericKey& key_of(const ConfigNode& node, const std::vector<NumericKey>& keys) {
  const auto found = std::ranges::find(keys, node.key, &NumericKey::key);
  if (found != keys.end()) return *found;
  std::vector<std::string> known;
  for (const NumericKey& key : keys) known.push_back(key.key);
  refuse_input(node.origin, "parameters." + node.key,
               "expected a numeric key of the scenario" + did_you_mean(node.key, known));
}

void read_parameters(const ConfigNode& group, TuneFile& tune) {
  const std::vector<NumericKey> keys = numeric_keys(tune.scenario);
  for (const ConfigNode& node : group.children) {
    const NumericKey& key = key_of(node, keys);
    if (tune.over == TuningData::recordings && !matters_on_recordings(tune.scenario, key.key))
      refuse_input(node.origin, "parameters." + node.key,
                   fmt::format("expected a key of the scenario's detector, perception.{}: this one changes "
                               "nothing on recordings",
                               tune.scenario.perception.detector));
    tune.space.parameters.push_back(parameter_of(node, key));
    tune.scenario_point.push_back(key.value);
    const std::size_t bracket = key.key.find('[');
    if (bracket == std::string::npos) continue;
    std::vector<double>& list = tune.space.lists[key.key.substr(0, bracket)];
    list.clear();
    for (const NumericKey& other : keys)
      if (other.key.starts_with(key.key.substr(0, bracket + 1))) list.push_back(other.value);
  }
}

std::size_t figure_of(const std::string& word, const TuneFile& tune) {
  return static_cast<std::size_t>(std::ranges::find(tune.figures, word) - tune.figures.begin());
}

void add_goals(const std::vector<std::string>& words, const ConfigNode& top, const std::string& key,
               TuneFile& tune) {
  for (const std::string& word : words) {
    const Goal goal{figure_of(word, tune), key.ends_with("maximize")};
    if (goal.figure == tune.figures.size())
      refuse_key(top, key,
                 fmt::format("one of {}, got '{}'{}", fmt::join(tune.figures, ", "), word,
                             did_you_mean(word, tune.figures)));
    if (std::ranges::find(tune.objective.goals, goal.figure, &Goal::figure) != tune.objective.goals.end())
      refuse_key_since(top, key, "this figure is named twice");
    tune.objective.goals.push_back(goal);
  }
}

void add_limits(const ConfigNode& bounds, const ConfigNode& top, const std::string& key, TuneFile& tune) {
  if (find_child(*find_child(top, "objective"), short_key(key)) == nullptr) return;
  if (bounds.kind != ConfigNode::Kind::map || bounds.children.empty())
    refuse_key(top, key, "bounds of figures: {precision: 0.97}");
  std::vector<double> values(tune.figures.size());
  const std::set<std::string> shares{"precision", "recall",  "f_score",         "trunks_1m",
                                     "trunks_3m", "success", "trunk_precision", "progress"};
  read_fields(
      bounds,
      [&](FieldVisitor& visit) {
        for (std::size_t i = 0; i < values.size(); ++i)
          visit(tune.figures[i], values[i], 0.0, shares.contains(tune.figures[i]) ? 1.0 : 1e9);
      },
      key);
  for (const ConfigNode& bound : bounds.children) {
    const std::size_t figure = figure_of(bound.key, tune);
    tune.objective.limits.push_back({figure, key.ends_with("at_least"), values[figure]});
  }
}

void take_objective(const ObjectiveText& text, const ConfigNode& top, TuneFile& tune) {
  add_goals(text.maximize, top, "objective.maximize", tune);
  add_goals(text.minimize, top, "objective.minimize", tune);
  add_limits(text.at_least, top, "objective.at_least", tune);
  add_limits(text.at_most, top, "objective.at_most", tune);
  if (tune.objective.goals.empty())
    refuse_key(top, "objective",
               fmt::format("maximize or minimize, with one of {}", fmt::join(tune.figures, ", ")));
  if (tune.over == TuningData::flights && tune.figures[tune.objective.goals.front().figure] == "success")
    tune.objective.tie_breaker = figure_of("progress", tune);
}

void check_search(const ConfigNode& top, TuneFile& tune) {
  const SearchMethod method = tune.search.method;
  const std::size_t goals = tune.objective.goals.size();
  const bool has_trials = tune.search.trials > 0;
  if (find_child(*find_child(top, "search"), "method") == nullptr)
    refuse_key(top, "search.method", "random | grid | cma_es | nsga2");
  if (method == SearchMethod::cma_es && goals > 1)
    refuse_key(top, "search.method", "nsga2, random or grid where there are several goals");
  if (method == SearchMethod::nsga2 && goals == 1)
    refuse_key(top, "search.method", "cma_es, random or grid where there is one goal");
  if (method != SearchMethod::grid) {
    if (!has_trials)
      refuse_key(top, "search.trials", fmt::format("a whole number from 1 to {}", maximum_trials));
    return;
  }
  if (has_trials)
    refuse_key_since(top, "search.trials", "must not be given for a grid: it tries every combination once");
  double size = 1;
  for (const Parameter& parameter : tune.space.parameters) {
    if (parameter.values.empty() && parameter.steps == 0)
      refuse_input(nearest_origin(top, "search"), "parameters." + parameter.key,
                   "expected values, or a range with steps, for a grid");
    size *= static_cast<double>(spread_values(parameter, parameter.steps).size());
  }
  if (size > maximum_trials)
    refuse_key(top, "search.method", fmt::format("a grid of at most {} points", maximum_trials));
  tune.search.trials = static_cast<int>(size);
}

/// The folders of this name; in the place of `*` and `?` anything may stand, as in a shell. By name.
std::vector<fs::path> folders_named(const fs::path& name) {
  std::vector<fs::path> folders;
  glob_t found{};
  if (glob(name.c_str(), GLOB_ONLYDIR, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i)
      if (std::error_code ignored; fs::is_directory(found.gl_pathv[i], ignored))
        folders.push_back(fs::canonical(found.gl_pathv[i]));
  globfree(&found);
  return folders;
}

/// Folders as they are, beside the file or where they are said to be, links resolved.
std::vector<fs::path> folders_of(const std::vector<std::string>& words, const ConfigNode& top,
                                 const std::string& key, const fs::path& file) {
  std::vector<fs::path> folders;
  for (const std::string& word : words) {
    std::vector<fs::path> named = folders_named(file.parent_path() / word);
    if (named.empty()) named = folders_named(word);
    if (named.empty()) refuse_key_since(top, key, fmt::format("there is no folder {}", word));
    folders.insert(folders.end(), named.begin(), named.end());
  }
  return folders;
}

bool holds(const fs::path& folder, const fs::path& other) {
  return std::mismatch(folder.begin(), folder.end(), other.begin(), other.end()).first == folder.end();
}

void take_data(const TuneText& text, const ConfigNode& top, const fs::path& file, TuneFile& tune) {
  if (tune.over == TuningData::flights) {
    if (!text.fly.empty()) refuse_key_since(top, "fly", "is for tunings over recordings: these fly anyway");
    tune.training_seeds = seeds_in(text.training, top, "training");
    tune.validation_seeds = seeds_in(text.validation, top, "validation");
    for (const std::uint64_t seed : tune.validation_seeds)
      if (std::ranges::find(tune.training_seeds, seed) != tune.training_seeds.end())
        refuse_key_since(top, "validation", fmt::format("seed {} is a seed of training, too", seed));
    return;
  }
  if (!text.fly.empty()) tune.fly = seeds_in(text.fly, top, "fly");
  std::set<fs::path> seen;
  for (const auto& [key, words, folders] :
       {std::tuple("training", &text.training, &tune.training_folders),
        std::tuple("validation", &text.validation, &tune.validation_folders)}) {
    if (words->empty()) refuse_key(top, key, "folders of recordings");
    *folders = folders_of(*words, top, key, file);
    for (const fs::path& folder : *folders)
      if (!seen.insert(folder).second)
        refuse_key_since(
            top, key,
            fmt::format("{} is given twice (training and validation need different data)", folder.string()));
  }
  for (const fs::path& one : tune.validation_folders)
    for (const fs::path& other : tune.training_folders)
      if (holds(one, other) || holds(other, one))
        refuse_key_since(top, "validation", fmt::format("{} is a recording of training, too", one.string()));
}

void require_group(const ConfigNode& top, const char* key, const std::string& expected) {
  const ConfigNode* group = find_child(top, key);
  if (group == nullptr || group->kind != ConfigNode::Kind::map || group->children.empty())
    refuse_key(top, key, expected);
}

}  // namespace

void visit_fields(FieldVisitor& visit, SearchConfig& search) {
  visit("method", search.method, search_method_names);
  visit("trials", search.trials, 1, maximum_trials);
  visit("seed", search.seed, 0, 2'000'000'000);
  visit("sensitivity", search.sensitivity_points, 2, 1000);
}

std::vector<NumericKey> numeric_keys(const Scenario& scenario) {
  std::vector<NumericKey> numeric;
  for (const Key& key : keys_of(scenario)) {
    if (key.name.find("[]") != std::string::npos) continue;  // of a list's entries in general
    for (std::size_t i = 0; i < key.numbers.size(); ++i)
      numeric.push_back({key.value.starts_with('[') ? fmt::format("{}[{}]", key.name, i) : key.name,
                         key.whole, key.minimum, key.maximum, key.numbers[i]});
  }
  return numeric;
}

TuneFile load_tune_file(const fs::path& file, const FindScenario& find_scenario) {
  const std::string written = read_file(file);
  const ConfigNode top = parse_yaml(written, file.string());
  if (find_child(top, "scenario") == nullptr)
    refuse_key(top, "scenario", "the scenario whose keys are tuned");
  TuneText text;
  read_config(top, text);
  TuneFile tune = std::move(text.tune);
  tune.text = written;
  tune.name = name_or_stem(text.name, top, file);
  tune.scenario_file = scenario_beside(file, top, "scenario", text.scenario, find_scenario);
  tune.scenario = load_scenario(tune.scenario_file);
  if (find_child(top, "over") == nullptr) refuse_key(top, "over", "recordings | flights");
  tune.figures = tune.over == TuningData::flights ? flight_figure_names : vision_figure_names;
  require_group(top, "parameters", "a group {key: {from: ..., to: ...}, ...}");
  read_parameters(text.parameters, tune);
  require_group(top, "objective", "a group {maximize: ...}");
  take_objective(text.objective, top, tune);
  require_group(top, "search", "a group {method: ..., trials: ..., seed: ...}");
  check_search(top, tune);
  take_data(text, top, file, tune);
  return tune;
}

}  // namespace understory
