#include <fmt/format.h>

#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/cli/part_check.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/plugin.hpp"

namespace understory {
namespace {

struct PluginArguments {
  std::vector<std::string> files;  ///< none: our own parts
  bool check = false;
};

template <typename List>
void add_parts(const List& list, const std::string& plugin, const std::string& kind, const std::string& key,
               Table& table, std::vector<Key>& keys) {
  for (const auto& part : list.all()) {
    if (part.plugin != plugin) continue;
    table.add(kind, part.name, key + "=" + part.name, part.meaning);
    if (!part.defaults) continue;
    const std::string group = key.find('.') == std::string::npos ? "" : key.substr(0, key.rfind('.') + 1);
    const auto config = part.defaults->clone();
    for (Key& own : list_keys(fields_of(*config), fmt::format("{}{}.", group, part.name)))
      keys.push_back(std::move(own));
  }
}

std::string list_of(const std::string& plugin) {
  Table table{{"Kind", "Name", "Chosen by", "Meaning"}};
  std::vector<Key> keys;
  add_parts(parts().detectors, plugin, "detector", "perception.detector", table, keys);
  add_parts(parts().state_sources, plugin, "state source", "estimation.source", table, keys);
  add_parts(parts().planners, plugin, "planner", "autopilot.method", table, keys);
  add_parts(parts().courses, plugin, "course", "course", table, keys);
  Table key_table{{"Key", "Default", "Unit", "Range", "Meaning"}};
  for (const Key& key : keys) key_table.add(key.name, key.value, key.unit, key.range, key.meaning);
  return keys.empty() ? to_text(table) : fmt::format("{}\n{}", to_text(table), to_text(key_table));
}

/// Whether all checks passed.
bool check(const std::string& plugin) {
  ProgressLine line;
  PartCheckOptions options{data_root() / "models", plugin};
  options.on_progress = [&](const std::string& what) { line.show(what); };
  const std::vector<PartCheck> checks = check_parts(options);
  line.clear();
  Table table{{"Part", "Check", "Result", ""}};
  std::size_t faults = 0;
  for (const PartCheck& one : checks) {
    if (!one.fault.empty()) ++faults;
    table.add(one.part, one.check, one.fault.empty() ? "passed" : "FAULT",
              one.fault.empty() ? one.note : one.fault);
  }
  fmt::print("\n{}\n{} checks, {} faults\n", to_text(table), checks.size(), faults);
  return faults == 0;
}

int run(const PluginArguments& arguments) {
  std::vector<std::string> plugins;
  std::string bad;
  for (const std::string& file : arguments.files) {
    try {
      plugins.push_back(load_plugin(file, "plugin").file);
    } catch (const ScenarioError& error) {  // the others are shown all the same
      if (!bad.empty()) fmt::print(stderr, "understory: {}\n", bad);
      bad = error.what();
    }
  }
  if (arguments.files.empty()) plugins.emplace_back();
  bool passed = true;
  for (const std::string& plugin : plugins) {
    fmt::print("{}\n\n{}", plugin.empty() ? "Parts of Understory" : plugin, list_of(plugin));
    if (arguments.check) passed = check(plugin) && passed;
  }
  if (!bad.empty()) throw ScenarioError(bad);
  return passed ? exit_goal : exit_not_goal;
}

}  // namespace

void add_plugin_command(CommandLine& line) {
  const auto arguments = std::make_shared<PluginArguments>();
  Command& command =
      line.add({"plugin", "list and test the parts in plug-ins: detectors, state sources, planners, courses",
                "understory plugin my_parts/edge_detector.so --check",
                "done; with --check: every check passed", "a check found a fault"});
  command.texts("file", "FILE", arguments->files, "plug-ins; without any: Understory's own parts");
  command.flag("--check", arguments->check, "test each part alone and in flights");
  command.runs([arguments] { return run(*arguments); });
}

}  // namespace understory
