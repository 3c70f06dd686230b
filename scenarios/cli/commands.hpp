#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understory {

/// Exit statuses of every command (README).
enum ExitStatus { exit_goal = 0, exit_not_goal = 1, exit_bad_input = 2, exit_machine_failed = 3 };

struct FlyArguments {
  std::string scenario;               ///< a path, or a name in scenarios/library
  std::vector<std::string> settings;  ///< key=value
  std::string out;                    ///< empty: runs/<name>-<seed>
  bool video = false;
  bool quiet = false;
};
int run_fly(const FlyArguments& arguments);

struct EvaluateArguments {
  std::string scenario;
  std::vector<std::string> settings;
  std::string seeds = "1000:1099";  ///< first:last, or one
  std::string csv;  ///< empty: no file; with one, seeds it already answers are not flown again
  std::string out;  ///< keeps the run folders here; empty: they are removed
  int jobs = 1;
};
int run_evaluate(const EvaluateArguments& arguments);

/// The source tree's root, where models/ and scenarios/library/ lie: $UNDERSTORY_ROOT, else the tree this
/// program was built from, else the tree its binary lies in. Throws MachineError where none of them has
/// models/.
std::filesystem::path project_root();

/// The file that a scenario argument means. Throws ScenarioError, naming what the library has, where there is
/// none.
std::filesystem::path scenario_file(const std::string& argument);

}  // namespace understory
