#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/cli/command_line.hpp"
#include "sim/render/renderer_kind.hpp"

namespace understory {

struct Campaign;
struct CampaignFolder;
struct Collected;

/// Each adds one command with its options.
void add_fly_command(CommandLine& line);
void add_record_command(CommandLine& line);
void add_report_command(CommandLine& line);
void add_mcap_command(CommandLine& line);
void add_campaign_command(CommandLine& line);
void add_shard_command(CommandLine& line);
void add_collect_command(CommandLine& line);
void add_gate_command(CommandLine& line);
void add_tune_command(CommandLine& line);
void add_detect_command(CommandLine& line);
void add_evaluate_command(CommandLine& line);
void add_rig_command(CommandLine& line);
void add_bench_command(CommandLine& line);
void add_keys_command(CommandLine& line);
void add_forest_command(CommandLine& line);
void add_plugin_command(CommandLine& line);

/// Prints what a campaign came to and leaves summary.md and campaign.svg in its folder, and with a name of a
/// file there JUnit XML. Gives the exit status: 0 where every flight was flown, whatever its outcome; 1 where
/// one was not.
int report(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
           const std::filesystem::path& junit = {});

/// OpenGL's name for what draws by default, or why nothing does.
std::string renderer_of_this_machine();

}  // namespace understory
