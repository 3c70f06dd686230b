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
void add_keys_command(CommandLine& line);

/// OpenGL's name for what draws by default, or why nothing does.
std::string renderer_of_this_machine();

}  // namespace understory
