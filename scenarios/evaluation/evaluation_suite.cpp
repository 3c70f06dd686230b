#include "scenarios/evaluation/evaluation_suite.hpp"

#include <fmt/format.h>

#include <set>
#include <string_view>

#include "scenarios/config/config_keys.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// YAML in one line again, as --set takes it.
std::string value_text(const ConfigNode& value) {
  if (value.kind != ConfigNode::Kind::list) return value.text;
  std::vector<std::string> parts;
  for (const ConfigNode& part : value.children) parts.push_back(value_text(part));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

void add_settings(const ConfigNode* set, std::vector<std::string>& settings) {
  if (set == nullptr) return;
  if (set->kind != ConfigNode::Kind::map) refuse_key(*set, "set", "a group {key: value, ...}");
  for (const ConfigNode& node : set->children) settings.push_back(node.key + "=" + value_text(node));
}

std::string word(const ConfigNode& entry, const char* key, const char* expected) {
  const ConfigNode* node = find_child(entry, key);
  if (node == nullptr || node->kind != ConfigNode::Kind::scalar || node->text.empty())
    refuse_key(node == nullptr ? entry : *node, std::string("recordings.") + key, expected);
  return node->text;
}

std::vector<std::uint64_t> seeds_in(const ConfigNode& entry) {
  constexpr const char* expected = "first..last, or a list of seeds";
  const ConfigNode* node = find_child(entry, "seeds");
  if (node == nullptr) refuse_key(entry, "recordings.seeds", expected);
  return seeds_of(words_of(*node, "recordings.seeds", expected), node->origin + ": recordings.seeds");
}

/// The entry's recordings: one for each seed.
std::vector<SuiteRecording> recordings_of(const ConfigNode& entry, const ConfigNode* set_of_all,
                                          const fs::path& folder, const FindScenario& find_scenario) {
  if (entry.kind != ConfigNode::Kind::map)
    refuse_key(entry, "recordings", "{name: ..., scenario: ..., seeds: ...}");
  require_known_keys(entry, {"name", "scenario", "seeds", "path", "walk_mps", "height_m", "set"},
                     "recordings.");
  const std::string name = word(entry, "name", "a name of letters, digits and . _ -");
  if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") !=
      std::string::npos)
    refuse_key(entry, "recordings.name", "a name of letters, digits and . _ -");
  const std::string scenario = word(entry, "scenario", "a scenario");
  const fs::path beside = folder / scenario;
  SuiteRecording recording;
  recording.scenario = fs::is_regular_file(beside) ? beside : find_scenario(scenario);
  if (find_child(entry, "path") != nullptr) {
    const fs::path path = folder / word(entry, "path", "a file of poses");
    if (!fs::is_regular_file(path))
      refuse_key(*find_child(entry, "path"), "recordings.path",
                 "a file of poses, found none at " + path.string());
    recording.arguments.insert(recording.arguments.end(), {"--path", path.string()});
  }
  if (find_child(entry, "walk_mps") != nullptr)
    recording.arguments.push_back("--walk=" + word(entry, "walk_mps", "a speed"));
  if (find_child(entry, "height_m") != nullptr)
    recording.arguments.insert(recording.arguments.end(), {"--height", word(entry, "height_m", "a height")});
  add_settings(set_of_all, recording.settings);
  add_settings(find_child(entry, "set"), recording.settings);
  std::vector<SuiteRecording> recordings;
  for (const std::uint64_t seed : seeds_in(entry)) {
    recordings.push_back(recording);
    recordings.back().name = fmt::format("{}-{}", name, seed);
    recordings.back().settings.push_back(fmt::format("seed={}", seed));
  }
  return recordings;
}

}  // namespace

EvaluationSuite load_evaluation_suite(const fs::path& file, const FindScenario& find_scenario) {
  const ConfigNode top = parse_config_file(file);
  require_known_keys(top, {"recordings", "set"}, "");
  const ConfigNode* list = find_child(top, "recordings");
  if (list == nullptr || list->kind != ConfigNode::Kind::list || list->children.empty())
    refuse_key(list == nullptr ? top : *list, "recordings",
               "a list [{name: ..., scenario: ..., seeds: ...}, ...]");
  EvaluationSuite suite;
  suite.name = file.stem().string();
  std::set<std::string> names;
  for (const ConfigNode& entry : list->children)
    for (SuiteRecording& recording :
         recordings_of(entry, find_child(top, "set"), file.parent_path(), find_scenario)) {
      if (!names.insert(recording.name).second)
        refuse_key(entry, "recordings",
                   fmt::format("each recording once, {} is given twice", recording.name));
      suite.recordings.push_back(std::move(recording));
    }
  return suite;
}

}  // namespace understory
