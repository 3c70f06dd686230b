#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "sim/render/renderer_kind.hpp"

namespace CLI {
class App;
}

namespace understory {

/// Exit statuses of every command (README). `validate` ends with exit_not_goal where a tolerance is broken,
/// `gate` where a change may not pass.
enum ExitStatus { exit_goal = 0, exit_not_goal = 1, exit_bad_input = 2, exit_machine_failed = 3 };

/// What the command line asked for, parsed; returns the exit status.
using Command = std::function<int()>;

/// Each adds one command with its options to `app`; where that command is the one given, `chosen` becomes its
/// run.
void add_fly_command(CLI::App& app, Command& chosen);
void add_record_command(CLI::App& app, Command& chosen);
void add_campaign_command(CLI::App& app, Command& chosen);
void add_tune_command(CLI::App& app, Command& chosen);
void add_shard_command(CLI::App& app, Command& chosen);
void add_collect_command(CLI::App& app, Command& chosen);
void add_validate_command(CLI::App& app, Command& chosen);
void add_gate_command(CLI::App& app, Command& chosen);
void add_rig_command(CLI::App& app, Command& chosen);
void add_detect_command(CLI::App& app, Command& chosen);
void add_evaluate_command(CLI::App& app, Command& chosen);
void add_bench_command(CLI::App& app, Command& chosen);

/// The scenario's name, --with and --set, as every command that flies has them.
struct ScenarioArguments {
  std::string scenario;                     ///< a path, or a name in scenarios/library
  std::vector<std::filesystem::path> with;  ///< files of keys, over the scenario's own
  std::vector<std::string> settings;        ///< key=value, over both
};
void add_scenario_options(CLI::App& command, ScenarioArguments& arguments);
/// --set alone.
void add_settings_option(CLI::App& command, std::vector<std::string>& settings);

/// --renderer, as every command that draws has it; must outlive the parsing.
void add_renderer_option(CLI::App& command, RendererKind& renderer);

/// What `bench --closed-loop` was given.
struct ClosedLoopBenchArguments {
  int flights = 4;                    ///< of each kind: seeds 1000 and on
  std::vector<std::string> settings;  ///< key=value, of every flight
  RendererKind renderer = RendererKind::osmesa;
  std::string json;  ///< empty: none
};
/// Runs it; the exit status. Throws ScenarioError in a build without the simulator.
int run_closed_loop_bench(const ClosedLoopBenchArguments& arguments);

/// Records what `file` asks for (EvaluationSuite), `jobs` at once, each into FOLDER/NAME-SEED; what is there
/// already stays. The recordings' folders, in the file's order. Throws ScenarioError where the file is wrong
/// or one could not be recorded, or in a build without the simulator.
std::vector<std::filesystem::path> record_suite(const std::filesystem::path& file,
                                                const std::filesystem::path& folder, int jobs);

/// --unit, --size and --depth, as every command that reads a calibration has them.
struct CalibrationArguments {
  std::string unit = "m";
  std::string size;               ///< empty: the files say it
  std::optional<double> depth_m;  ///< nothing: the rig's own
};
void add_calibration_options(CLI::App& command, CalibrationArguments& arguments);
/// What they mean. Throws ScenarioError where they mean nothing.
CalibrationOptions calibration_options(const CalibrationArguments& arguments);
/// The path a rig argument means: one that exists, or a name in models/rigs. Throws ScenarioError, naming
/// what there is, where it means none.
std::filesystem::path rig_path(const std::string& argument);

/// The source tree's root, where models/ and scenarios/library/ lie: $UNDERSTORY_ROOT, else the tree this
/// program was built from, else the tree its binary lies in. Throws MachineError where none of them has
/// models/.
std::filesystem::path project_root();

/// The file that a scenario argument means. Throws ScenarioError, naming what the library has, where there is
/// none.
std::filesystem::path scenario_file(const std::string& argument);

}  // namespace understory
