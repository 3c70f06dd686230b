#include "scenarios/tuning/tune_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/tuning/judge.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr int maximum_trials = 1'000'000;

const ConfigNode& required(const ConfigNode& map, std::string_view key, const std::string& expected) {
  const ConfigNode* node = find_child(map, key);
  if (node == nullptr) refuse_key(map, std::string(key), expected);
  return *node;
}

const ConfigNode& required_group(const ConfigNode& map, std::string_view key, const std::string& expected) {
  const ConfigNode& node = required(map, key, expected);
  if (node.kind != ConfigNode::Kind::map || node.children.empty())
    refuse_key(node, std::string(key), expected);
  return node;
}

/// Within the bounds of its key, and whole where it is.
double value_of(const ConfigNode& node, const std::string& name, const NumericKey& key) {
  const double value = number_of(node, name, key.minimum, key.maximum);
  if (key.whole && value != std::round(value)) refuse_key(node, name, "a whole number");
  return value;
}

void read_range(const ConfigNode& node, const NumericKey& key, Parameter& parameter) {
  const std::string name = "parameters." + key.key;
  const std::string expected = "{from: ..., to: ..., scale: linear | log, steps: ...} or {values: [...]}";
  parameter.from = value_of(required(node, "from", expected), name + ".from", key);
  parameter.to = value_of(required(node, "to", expected), name + ".to", key);
  if (!(parameter.from < parameter.to)) refuse_input(node.origin, name, "from must be less than to");
  if (const ConfigNode* scale = find_child(node, "scale")) {
    if (scale->text != "linear" && scale->text != "log") refuse_key(*scale, name + ".scale", "linear | log");
    parameter.logarithmic = scale->text == "log";
    if (parameter.logarithmic && parameter.from <= 0)
      refuse_input(node.origin, name, "scale: log requires from above 0");
  }
  if (const ConfigNode* steps = find_child(node, "steps"))
    parameter.steps = whole_number_of(*steps, name + ".steps", 2, 1000);
}

Parameter parameter_of(const ConfigNode& node, const NumericKey& key) {
  const std::string name = "parameters." + node.key;
  Parameter parameter{key.key, key.whole};
  if (node.kind != ConfigNode::Kind::map) refuse_key(node, name, "{from: ..., to: ...} or {values: [...]}");
  require_known_keys(node, {"from", "to", "scale", "steps", "values"}, name + ".");
  const ConfigNode* values = find_child(node, "values");
  if (values == nullptr) {
    read_range(node, key, parameter);
    return parameter;
  }
  if (values->kind != ConfigNode::Kind::list || values->children.size() < 2 || node.children.size() > 1)
    refuse_input(values->origin, name + ".values",
                 "must be a list of two values or more, without from and to");
  for (const ConfigNode& value : values->children)
    parameter.values.push_back(value_of(value, name + ".values", key));
  std::ranges::sort(parameter.values);
  if (std::ranges::adjacent_find(parameter.values) != parameter.values.end())
    refuse_input(values->origin, name + ".values", "all values must be different");
  return parameter;
}

const NumericKey& key_of(const ConfigNode& node, const std::vector<NumericKey>& keys) {
  const auto found = std::ranges::find(keys, node.key, &NumericKey::key);
  if (found != keys.end()) return *found;
  std::vector<std::string> known;
  for (const NumericKey& key : keys) known.push_back(key.key);
  refuse_key(node, "parameters." + node.key, "a numeric key of the scenario" + did_you_mean(node.key, known));
}

void read_parameters(const ConfigNode& group, TuneFile& tune) {
  const std::vector<NumericKey> keys = numeric_keys(tune.scenario);
  for (const ConfigNode& node : group.children) {
    const NumericKey& key = key_of(node, keys);
    if (tune.over == TuningData::recordings && !matters_on_recordings(key.key))
      refuse_key(node, "parameters." + node.key,
                 "a key of perception.pushbroom or perception.depths_m: no other key changes anything on "
                 "recordings");
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

std::size_t figure_of(const ConfigNode& node, const std::string& key, const std::string& word,
                      const std::vector<std::string>& names) {
  const auto found = std::ranges::find(names, word);
  if (found == names.end())
    refuse_key(node, key, fmt::format("one of {}, got '{}'", fmt::join(names, ", "), word));
  return static_cast<std::size_t>(found - names.begin());
}

void read_objective(const ConfigNode& group, TuneFile& tune) {
  require_known_keys(group, {"maximize", "minimize", "at_least", "at_most"}, "objective.");
  std::set<std::size_t> aimed_at;
  for (const ConfigNode& node : group.children) {
    const std::string name = "objective." + node.key;
    if (node.key == "maximize" || node.key == "minimize") {
      for (const std::string& word : words_of(node, name, "a figure, or a list of such")) {
        const std::size_t figure = figure_of(node, name, word, tune.figures);
        if (!aimed_at.insert(figure).second) refuse_input(node.origin, name, "this figure is named twice");
        tune.objective.goals.push_back({figure, node.key == "maximize"});
      }
      continue;
    }
    if (node.kind != ConfigNode::Kind::map || node.children.empty())
      refuse_key(node, name, "bounds of figures: {precision: 0.97}");
    for (const ConfigNode& bound : node.children)
      tune.objective.limits.push_back({figure_of(bound, name, bound.key, tune.figures),
                                       node.key == "at_least",
                                       number_of(bound, name + "." + bound.key, -1e9, 1e9)});
  }
  if (tune.objective.goals.empty())
    refuse_key(group, "objective",
               "maximize or minimize, with one of " + fmt::format("{}", fmt::join(tune.figures, ", ")));
  if (tune.over == TuningData::flights && tune.figures[tune.objective.goals.front().figure] == "success")
    tune.objective.tie_breaker = figure_of(group, "objective", "progress", tune.figures);
}

void read_search(const ConfigNode& group, TuneFile& tune) {
  require_known_keys(group, {"method", "trials", "seed", "sensitivity"}, "search.");
  std::vector<std::string> methods;
  for (const auto& [word, method] : search_method_names) methods.emplace_back(word);
  const std::string expected = fmt::format("{}", fmt::join(methods, " | "));
  const ConfigNode& method = required(group, "method", expected);
  const auto found =
      std::ranges::find(search_method_names, method.text, &std::pair<std::string_view, SearchMethod>::first);
  if (found == search_method_names.end()) refuse_key(method, "search.method", expected);
  tune.search.method = found->second;
  const std::size_t goals = tune.objective.goals.size();
  if (found->second == SearchMethod::cma_es && goals > 1)
    refuse_key(method, "search.method", "nsga2, random or grid where there are several goals");
  if (found->second == SearchMethod::nsga2 && goals == 1)
    refuse_key(method, "search.method", "cma_es, random or grid where there is one goal");
  if (const ConfigNode* seed = find_child(group, "seed"))
    tune.search.seed = static_cast<std::uint64_t>(whole_number_of(*seed, "search.seed", 0, 2'000'000'000));
  if (const ConfigNode* points = find_child(group, "sensitivity"))
    tune.search.sensitivity_points = whole_number_of(*points, "search.sensitivity", 2, 1000);
  const ConfigNode* trials = find_child(group, "trials");
  if (found->second != SearchMethod::grid) {
    const std::string wanted = fmt::format("a whole number from 1 to {}", maximum_trials);
    tune.search.trials =
        whole_number_of(required(group, "trials", wanted), "search.trials", 1, maximum_trials);
    return;
  }
  if (trials != nullptr)
    refuse_input(trials->origin, "search.trials",
                 "must not be given for a grid: it tries every combination once");
  double size = 1;
  for (const Parameter& parameter : tune.space.parameters) {
    if (parameter.values.empty() && parameter.steps == 0)
      refuse_key(group, "parameters." + parameter.key, "values, or a range with steps, for a grid");
    size *= static_cast<double>(spread_values(parameter, parameter.steps).size());
  }
  if (size > maximum_trials)
    refuse_key(group, "search.method", fmt::format("a grid of at most {} points", maximum_trials));
  tune.search.trials = static_cast<int>(size);
}

/// Folders as they are, beside the file or where they are said to be, links resolved.
std::vector<fs::path> folders_of(const ConfigNode& node, const fs::path& file) {
  std::vector<fs::path> folders;
  for (const std::string& word : words_of(node, node.key, "folders of recordings")) {
    std::error_code ignored;
    const fs::path beside = file.parent_path() / word;
    const fs::path folder = fs::is_directory(beside, ignored) ? beside : fs::path(word);
    if (!fs::is_directory(folder, ignored))
      refuse_input(node.origin, node.key, fmt::format("there is no folder {}", word));
    folders.push_back(fs::canonical(folder));
  }
  return folders;
}

bool holds(const fs::path& folder, const fs::path& other) {
  return std::mismatch(folder.begin(), folder.end(), other.begin(), other.end()).first == folder.end();
}

void read_data(const ConfigNode& top, const fs::path& file, TuneFile& tune) {
  if (tune.over == TuningData::flights) {
    tune.training_seeds = seeds_in(top, "training");
    tune.validation_seeds = seeds_in(top, "validation");
    for (const std::uint64_t seed : tune.validation_seeds)
      if (std::ranges::find(tune.training_seeds, seed) != tune.training_seeds.end())
        refuse_input(find_child(top, "validation")->origin, "validation",
                     fmt::format("seed {} is a seed of training, too", seed));
    return;
  }
  const ConfigNode& training = required(top, "training", "folders of recordings");
  const ConfigNode& validation = required(top, "validation", "folders of recordings");
  tune.training_folders = folders_of(training, file);
  tune.validation_folders = folders_of(validation, file);
  std::set<fs::path> seen;
  for (const fs::path& one : tune.validation_folders)
    for (const fs::path& other : tune.training_folders)
      if (holds(one, other) || holds(other, one))
        refuse_input(validation.origin, "validation",
                     fmt::format("{} is a recording of training, too", one.string()));
  for (const auto* some : {&tune.training_folders, &tune.validation_folders})
    for (const fs::path& folder : *some)
      if (!seen.insert(folder).second)
        refuse_input((some == &tune.training_folders ? training : validation).origin, "training",
                     fmt::format("{} is given twice", folder.string()));
}

}  // namespace

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
  TuneFile tune;
  tune.text = read_file(file);
  const ConfigNode top = parse_yaml(tune.text, file.string());
  require_known_keys(top,
                     {"name", "scenario", "parameters", "objective", "search", "over", "training",
                      "validation", "every", "timeout_s"},
                     "");
  tune.name = name_in(top, file);
  const ConfigNode& scenario = required(top, "scenario", "the scenario whose keys are tuned");
  tune.scenario_file = scenario_beside(file, scenario, scenario.text, find_scenario);
  tune.scenario = load_scenario(tune.scenario_file);

  const ConfigNode& over = required(top, "over", "recordings | flights");
  if (over.text != "recordings" && over.text != "flights") refuse_key(over, "over", "recordings | flights");
  tune.over = over.text == "flights" ? TuningData::flights : TuningData::recordings;
  tune.figures = tune.over == TuningData::flights ? flight_figure_names : vision_figure_names;
  if (const ConfigNode* timeout = find_child(top, "timeout_s"))
    tune.timeout_s = number_of(*timeout, "timeout_s", 1, 86400);

  if (const ConfigNode* every = find_child(top, "every"))
    tune.every = whole_number_of(*every, "every", 1, 1000);

  read_parameters(required_group(top, "parameters", "a group {key: {from: ..., to: ...}, ...}"), tune);
  read_objective(required_group(top, "objective", "a group {maximize: ...}"), tune);
  read_search(required_group(top, "search", "a group {method: ..., trials: ..., seed: ...}"), tune);
  read_data(top, file, tune);
  return tune;
}

}  // namespace understory
