#include "scenarios/evaluation/evaluation_suite.hpp"

#include <fmt/format.h>

#include <optional>
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

/// An entry of the file as it stands: a recording for each seed.
struct SuiteEntry {
  std::string name, scenario, path;
  std::vector<std::string> seeds;
  std::optional<double> walk_mps, height_m;
  ConfigNode set;
};

void visit_fields(FieldVisitor& visit, SuiteEntry& entry) {
  visit("name", entry.name);
  visit("scenario", entry.scenario);
  visit("seeds", entry.seeds, "the seeds to fly, for instance 1..200");
  visit("path", entry.path);
  visit("walk_mps", entry.walk_mps, 0.1, 5.0);
  visit("height_m", entry.height_m, 0.3, 8.0);
  visit("set", entry.set);
}

struct SuiteText {
  std::vector<SuiteEntry> recordings;
  ConfigNode set;
};

void visit_fields(FieldVisitor& visit, SuiteText& text) {
  visit("recordings", text.recordings);
  visit("set", text.set);
}

/// YAML in one line again, as --set takes it.
std::string value_text(const ConfigNode& value) {
  if (value.kind != ConfigNode::Kind::list) return value.text;
  std::vector<std::string> parts;
  for (const ConfigNode& part : value.children) parts.push_back(value_text(part));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

void add_settings(const ConfigNode& set, const ConfigNode& top, const std::string& key,
                  std::vector<std::string>& settings) {
  if (set.kind != ConfigNode::Kind::map && !set.origin.empty())
    refuse_key(top, key, "a group {key: value, ...}");
  for (const ConfigNode& node : set.children) settings.push_back(node.key + "=" + value_text(node));
}

/// The entry's recordings: one for each seed. `here` is its key: "recordings[0]".
std::vector<SuiteRecording> recordings_of(const SuiteEntry& entry, const ConfigNode& set_of_all,
                                          const ConfigNode& top, const std::string& here,
                                          const fs::path& folder, const FindScenario& find_scenario) {
  if (!is_plain_name(entry.name)) refuse_key(top, here + ".name", "a name of letters, digits and . _ = -");
  if (entry.scenario.empty()) refuse_key(top, here + ".scenario", "a scenario");
  SuiteRecording recording;
  recording.origin = nearest_origin(top, here);
  recording.scenario =
      scenario_beside(folder / "suite", top, here + ".scenario", entry.scenario, find_scenario);
  if (!entry.path.empty() && entry.walk_mps)
    refuse_key_since(top, here + ".walk_mps", "path and walk_mps exclude each other");
  if (entry.height_m && !entry.walk_mps)
    refuse_key_since(top, here + ".height_m", "requires walk_mps: it is the height of a walk");
  if (!entry.path.empty()) {
    const fs::path path = folder / entry.path;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
      refuse_key(top, here + ".path", "a file of poses, found none at " + path.string());
    recording.arguments.insert(recording.arguments.end(), {"--path", path.string()});
  }
  if (entry.walk_mps) recording.arguments.push_back(fmt::format("--walk={}", *entry.walk_mps));
  if (entry.height_m)
    recording.arguments.insert(recording.arguments.end(), {"--height", fmt::format("{}", *entry.height_m)});
  add_settings(set_of_all, top, "set", recording.settings);
  add_settings(entry.set, top, here + ".set", recording.settings);
  std::vector<SuiteRecording> recordings;
  for (const std::uint64_t seed : seeds_in(entry.seeds, top, here + ".seeds")) {
    recordings.push_back(recording);
    recordings.back().name = fmt::format("{}-{}", entry.name, seed);
    recordings.back().settings.push_back(fmt::format("seed={}", seed));
  }
  return recordings;
}

std::vector<SuiteRecording> load_suite(const fs::path& file, const FindScenario& find_scenario) {
  const ConfigNode top = parse_config_file(file);
  SuiteText text;
  read_config(top, text);
  if (text.recordings.empty())
    refuse_key(top, "recordings", "a list [{name: ..., scenario: ..., seeds: ...}, ...]");
  std::vector<SuiteRecording> suite;
  std::set<std::string> names;
  for (std::size_t i = 0; i < text.recordings.size(); ++i) {
    const std::string here = fmt::format("recordings[{}]", i);
    for (SuiteRecording& recording :
         recordings_of(text.recordings[i], text.set, top, here, file.parent_path(), find_scenario)) {
      if (!names.insert(recording.name).second)
        refuse_key(top, here, fmt::format("each recording once, {} is given twice", recording.name));
      suite.push_back(std::move(recording));
    }
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
  const UnfinishedFolder said(folder / "said", evaluation_results, folder);
  const fs::path processes_said = said.path();
  ProgressLine line;
  ProgramProcesses processes(jobs, [&](std::uint64_t tag, int status, const EndedProcess&) {
    if (status == 0) {
      const fs::path recording = folder / suite[tag].name;
      FolderMark mark(recording, flight_results, recording);
      write_whole_file(recording / identity_name, identities[tag], &mark);
    }
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
