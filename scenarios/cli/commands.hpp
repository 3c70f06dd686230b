#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/cli/command_line.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

/// Each adds one command with its options.
void add_fly_command(CommandLine& line);
void add_record_command(CommandLine& line);
void add_campaign_command(CommandLine& line);
void add_shard_command(CommandLine& line);
void add_collect_command(CommandLine& line);
void add_gate_command(CommandLine& line);
void add_tune_command(CommandLine& line);
void add_detect_command(CommandLine& line);
void add_evaluate_command(CommandLine& line);
void add_rig_command(CommandLine& line);
void add_bench_command(CommandLine& line);

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

/// OpenGL's name for what draws by default, or why nothing does.
std::string renderer_of_this_machine();

}  // namespace understory
