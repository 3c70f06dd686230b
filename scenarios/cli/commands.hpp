#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace understory {

/// Exit statuses of every command (README).
enum ExitStatus { exit_goal = 0, exit_not_goal = 1, exit_bad_input = 2, exit_machine_failed = 3 };

/// What the command line asked for, parsed; returns the exit status.
using Command = std::function<int()>;

/// Each adds one command with its options to `app`; where that command is the one given, `chosen` becomes its
/// run.
void add_fly_command(CLI::App& app, Command& chosen);
void add_evaluate_command(CLI::App& app, Command& chosen);
void add_rig_command(CLI::App& app, Command& chosen);

/// The scenario's name and --set, as every command that flies has them.
struct ScenarioArguments {
  std::string scenario;               ///< a path, or a name in scenarios/library
  std::vector<std::string> settings;  ///< key=value
};
void add_scenario_options(CLI::App& command, ScenarioArguments& arguments);

/// The source tree's root, where models/ and scenarios/library/ lie: $UNDERSTORY_ROOT, else the tree this
/// program was built from, else the tree its binary lies in. Throws MachineError where none of them has
/// models/.
std::filesystem::path project_root();

/// The file that a scenario argument means. Throws ScenarioError, naming what the library has, where there is
/// none.
std::filesystem::path scenario_file(const std::string& argument);

}  // namespace understory
