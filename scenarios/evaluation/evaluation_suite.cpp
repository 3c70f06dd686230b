#include "scenarios/evaluation/evaluation_suite.hpp"

#include <fmt/format.h>

#include <set>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/flight_identity.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// A recording asked for, in the words of `understory record`.
struct SuiteRecording {
  std::string origin;  ///< "suite.yaml:3"
  std::string name;    ///< of its folder: the entry's name and the seed, "level-7"
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
  SuiteRecording recording;
  recording.origin = entry.origin;
  recording.scenario =
      scenario_beside(folder / "suite", *find_child(entry, "scenario"), scenario, find_scenario);
  if (find_child(entry, "path") != nullptr && find_child(entry, "walk_mps") != nullptr)
    refuse_input(find_child(entry, "walk_mps")->origin, "recordings.walk_mps",
                 "path and walk_mps exclude each other");
  if (const ConfigNode* height = find_child(entry, "height_m"); height != nullptr) {
    number_of(*height, "recordings.height_m", 0.3, 8);
    if (find_child(entry, "walk_mps") == nullptr)
      refuse_input(height->origin, "recordings.height_m", "requires walk_mps: it is the height of a walk");
  }
  if (const ConfigNode* walk = find_child(entry, "walk_mps")) number_of(*walk, "recordings.walk_mps", 0.1, 5);
  if (find_child(entry, "path") != nullptr) {
    const fs::path path = folder / word(entry, "path", "a file of poses");
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
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

/// What decides a recording, as text: its scenario, how the cameras are carried, and what flies and draws it.
std::string identity_text(const SuiteRecording& recording, const Scenario& scenario, Identity identity) {
  const std::string rig = rig_name_in_identity(scenario);
  std::erase_if(identity,
                [&](const auto& entry) { return entry.first.starts_with("rig ") && entry.first != rig; });
  identity.emplace_back("scenario", digest_of_text(scenario_to_text(scenario)));
  for (std::size_t i = 0; i < recording.arguments.size(); ++i) {
    const bool is_path = i > 0 && recording.arguments[i - 1] == "--path";
    identity.emplace_back(recording.arguments[i], is_path ? digest_of_file(recording.arguments[i]) : "");
  }
  std::string text;
  for (const auto& [name, digest] : identity) text += fmt::format("{}: {}\n", name, digest);
  return text;
}

constexpr const char* identity_name = "identity.txt";

/// What keeps a recording that is there from being taken; empty: nothing.
std::string fault_of(const fs::path& folder, const std::string& identity) {
  std::error_code ignored;
  if (!fs::exists(folder / identity_name, ignored)) return "nothing says what it is a recording of";
  const std::string held = read_file(folder / identity_name);
  for (std::size_t begin = 0, end; begin < identity.size(); begin = end + 1) {
    end = identity.find('\n', begin);
    const std::string line = identity.substr(begin, end + 1 - begin);
    if (held.find(line) == std::string::npos) return line.substr(0, line.rfind(": ")) + " changed since";
  }
  return held.size() == identity.size() ? "" : "it was carried otherwise";
}

std::vector<std::string> arguments_of(const SuiteRecording& recording, const fs::path& folder) {
  std::vector<std::string> arguments{
      "record", recording.scenario.string(), "--quiet", "--force", "--out", folder.string()};
  arguments.insert(arguments.end(), recording.arguments.begin(), recording.arguments.end());
  for (const std::string& setting : recording.settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

}  // namespace

std::vector<fs::path> record_suite(const fs::path& file, const fs::path& folder, int jobs,
                                   const FindScenario& find_scenario, const fs::path& models) {
  const std::vector<SuiteRecording> suite = load_suite(file, find_scenario);
  std::vector<Scenario> scenarios;
  for (const SuiteRecording& recording : suite) try {  // what a child process would refuse
      scenarios.push_back(load_scenario(recording.scenario, recording.settings));
      rig_of(scenarios.back(), models);
    } catch (const ScenarioError& error) {
      throw ScenarioError(fmt::format("{}: {}: {}", file.string(), recording.name, error.what()));
    }
  const Identity identity = identity_of(scenarios, models, opened_renderer(RendererKind::osmesa));
  std::vector<std::string> identities;
  for (std::size_t i = 0; i < suite.size(); ++i)
    identities.push_back(identity_text(suite[i], scenarios[i], identity));
  prepare_output_folder(folder);
  const std::size_t all = suite.size();
  std::size_t failed = all, done = 0, here = 0;
  int failed_with = 0;
  std::string reason;
  const UnfinishedFolder said(folder / "said", "evaluation", folder);
  const fs::path processes_said = said.path();
  ProgressLine line;
  ProgramProcesses processes(jobs, [&](std::uint64_t tag, int status, const EndedProcess&) {
    if (status == 0) write_whole_file(folder / suite[tag].name / identity_name, identities[tag]);
    if (status != 0 && failed == all) {
      failed = static_cast<std::size_t>(tag);
      failed_with = status;
      reason = last_line_of(processes_said / suite[tag].name);
    }
    ++done;
    line.show(fmt::format("{} of {} recorded", done, all), ++here, all - done);
  });
  std::vector<fs::path> folders;
  for (const SuiteRecording& recording : suite) {
    folders.push_back(folder / recording.name);
    std::error_code ignored;
    if (fs::exists(folders.back() / "mav0", ignored)) {
      const std::string fault = fault_of(folders.back(), identities[folders.size() - 1]);
      if (fault.empty()) {
        ++done;
        continue;
      }
      line.clear();
      fmt::print("{}: recorded anew: {}\n", folders.back().string(), fault);
    }
    fs::remove(folders.back() / identity_name, ignored);  // from here on it is no recording of anything
    processes.start(folders.size() - 1, arguments_of(recording, folders.back()),
                    processes_said / recording.name);
  }
  processes.wait_for_all();
  if (failed < all) {
    const std::string what =
        fmt::format("{}: {} could not be recorded: {}", suite[failed].origin, suite[failed].name, reason);
    if (failed_with != 2) throw MachineError(what);  // exit_bad_input of the command line
    throw ScenarioError(what);
  }
  return folders;
}

}  // namespace understory
