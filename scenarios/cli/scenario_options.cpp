#include <CLI/CLI.hpp>

#include "scenarios/cli/commands.hpp"

namespace understory {

void add_scenario_options(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("scenario", arguments.scenario, "a scenario file, or a name from scenarios/library")
      ->required();
  command.add_option("--set", arguments.settings, "key=value, as in the scenario file: forest.length_m=30")
      ->allow_extra_args(false)
      ->trigger_on_parse(false);
}

}  // namespace understory
