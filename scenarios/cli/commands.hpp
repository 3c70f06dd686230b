#pragma once

#include <filesystem>
#include <string>

#include "scenarios/cli/command_line.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

struct Campaign;
struct CampaignFolder;
struct Collected;
struct GateVerdict;

/// Each adds one command with its options.
void add_fly_command(CommandLine& line);
void add_record_command(CommandLine& line);
void add_report_command(CommandLine& line);
void add_mcap_command(CommandLine& line);
void add_campaign_command(CommandLine& line);
void add_shard_command(CommandLine& line);
void add_collect_command(CommandLine& line);
void add_gate_command(CommandLine& line);
void add_explain_command(CommandLine& line);
void add_tune_command(CommandLine& line);
void add_detect_command(CommandLine& line);
void add_evaluate_command(CommandLine& line);
void add_images_command(CommandLine& line);
void add_rig_command(CommandLine& line);
void add_bench_command(CommandLine& line);
void add_keys_command(CommandLine& line);
void add_forest_command(CommandLine& line);
void add_plugin_command(CommandLine& line);

/// Prints a campaign's results, writes summary.md and campaign.svg into its folder, and JUnit XML if a file
/// `junit` is given. Returns the exit status: 0 if every flight was flown, with any outcome; else 1.
int report(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
           const std::filesystem::path& junit = {});

/// What a run's result.json says.
struct RunResult {
  std::string digest;  ///< empty where the run never came to its end
  bool reached_goal = false;
};
/// Throws ScenarioError where the file is none.
RunResult result_of_run(const std::filesystem::path& run);

/// Explains the lost flights of a campaign that are not explained yet, and writes what came of it into its
/// tables. A signal leaves what is explained until then.
void explain_campaign(const std::filesystem::path& folder, RendererKind renderer, int jobs, int flights);

/// The exit status that a gate's verdict has.
int status_of(const GateVerdict& verdict);

/// OpenGL's name of the default renderer, or why there is none.
std::string renderer_of_this_machine();

}  // namespace understory
