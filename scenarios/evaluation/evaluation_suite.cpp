#include "scenarios/evaluation/evaluation_suite.hpp"

#include <fmt/format.h>

#include <set>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// A recording asked for, in the words of `understory record`.
struct SuiteRecording {
  std::string name;  ///< of its folder: the entry's name and the seed, "level-7"
  fs::path scenario;
  std::vector<std::string> settings;   ///< of --set, the seed among them
  std::vector<std::string> arguments;  ///< further ones: --path, --walk, --height
};

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

/// The entry's recordings: one for each seed.
std::vector<SuiteRecording> recordings_of(const ConfigNode& entry, const ConfigNode* set_of_all,
                                          const fs::path& folder, const FindScenario& find_scenario) {
  if (entry.kind != ConfigNode::Kind::map)
    refuse_key(entry, "recordings", "{name: ..., scenario: ..., seeds: ...}");
  require_known_keys(entry, {"name", "scenario", "seeds", "path", "walk_mps", "height_m", "set"},
                     "recordings.");
  const std::string name = word(entry, "name", "a name of letters, digits and . _ = -");
  if (!is_plain_name(name)) refuse_key(entry, "recordings.name", "a name of letters, digits and . _ = -");
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
  for (const std::uint64_t seed : seeds_in(entry, "seeds", "recordings.")) {
    recordings.push_back(recording);
    recordings.back().name = fmt::format("{}-{}", name, seed);
    recordings.back().settings.push_back(fmt::format("seed={}", seed));
  }
  return recordings;
}

std::vector<SuiteRecording> load_suite(const fs::path& file, const FindScenario& find_scenario) {
  const ConfigNode top = parse_config_file(file);
  require_known_keys(top, {"recordings", "set"}, "");
  const ConfigNode* list = find_child(top, "recordings");
  if (list == nullptr || list->kind != ConfigNode::Kind::list || list->children.empty())
    refuse_key(list == nullptr ? top : *list, "recordings",
               "a list [{name: ..., scenario: ..., seeds: ...}, ...]");
  std::vector<SuiteRecording> suite;
  std::set<std::string> names;
  for (const ConfigNode& entry : list->children)
    for (SuiteRecording& recording :
         recordings_of(entry, find_child(top, "set"), file.parent_path(), find_scenario)) {
      if (!names.insert(recording.name).second)
        refuse_key(entry, "recordings",
                   fmt::format("each recording once, {} is given twice", recording.name));
      suite.push_back(std::move(recording));
    }
  return suite;
}

std::vector<std::string> arguments_of(const SuiteRecording& recording, const fs::path& folder) {
  std::vector<std::string> arguments{"record", recording.scenario.string(), "--quiet", "--out",
                                     folder.string()};
  arguments.insert(arguments.end(), recording.arguments.begin(), recording.arguments.end());
  for (const std::string& setting : recording.settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

}  // namespace

std::vector<fs::path> record_suite(const fs::path& file, const fs::path& folder, int jobs,
                                   const FindScenario& find_scenario, const fs::path& models) {
  const std::vector<SuiteRecording> suite = load_suite(file, find_scenario);
  for (const SuiteRecording& recording : suite) try {  // what a child process would refuse
      rig_of(load_scenario(recording.scenario, recording.settings), models);
    } catch (const ScenarioError& error) {
      throw ScenarioError(fmt::format("{}: {}: {}", file.string(), recording.name, error.what()));
    }
  prepare_output_folder(folder);
  const std::size_t all = suite.size();
  std::size_t failed = all, done = 0, here = 0;
  ProgressLine line;
  ProgramProcesses processes(jobs, [&](std::uint64_t tag, int status, const EndedProcess&) {
    if (status != 0 && failed == all) failed = static_cast<std::size_t>(tag);
    ++done;
    line.show(fmt::format("{} of {} recorded", done, all), ++here, all - done);
  });
  std::vector<fs::path> folders;
  for (const SuiteRecording& recording : suite) {
    folders.push_back(folder / recording.name);
    if (fs::exists(folders.back() / "mav0")) {  // it bears that name only when it is whole
      ++done;
      continue;
    }
    processes.start(folders.size() - 1, arguments_of(recording, folders.back()));
  }
  processes.wait_for_all();
  if (failed < all)
    throw ScenarioError(
        fmt::format("{}: expected to record {}, which failed", file.string(), suite[failed].name));
  return folders;
}

}  // namespace understory
