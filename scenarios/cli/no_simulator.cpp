#include "scenarios/cli/commands.hpp"
#include "scenarios/evaluation/evaluation_suite.hpp"

/// The commands of a build without the simulator (UNDERSTORY_SIM=OFF).
namespace understory {
namespace {

void add_refusal(CommandLine& line, const std::string& name) {
  Command& command = line.add({name, "not in this build: it has no simulator", "understory detect --help"});
  command.takes_anything();
  command.runs([name]() -> int {
    throw ScenarioError(name +
                        ": requires a build with the simulator (this one was made with UNDERSTORY_SIM=OFF)");
  });
}

}  // namespace

std::vector<std::filesystem::path> record_suite(const std::filesystem::path& file,
                                                const std::filesystem::path&, int, const FindScenario&,
                                                const std::filesystem::path&) {
  throw ScenarioError(
      file.string() +
      ": must be a folder of recordings: this build has no simulator to record with (UNDERSTORY_SIM=OFF)");
}

void add_fly_command(CommandLine& line) { add_refusal(line, "fly"); }
void add_record_command(CommandLine& line) { add_refusal(line, "record"); }
void add_report_command(CommandLine& line) { add_refusal(line, "report"); }
void add_mcap_command(CommandLine& line) { add_refusal(line, "mcap"); }
void add_campaign_command(CommandLine& line) { add_refusal(line, "campaign"); }
void add_explain_command(CommandLine& line) { add_refusal(line, "explain"); }
void add_tune_command(CommandLine& line) { add_refusal(line, "tune"); }
void add_shard_command(CommandLine& line) { add_refusal(line, "shard"); }
void add_gate_command(CommandLine& line) { add_refusal(line, "gate"); }
void add_plugin_command(CommandLine& line) { add_refusal(line, "plugin"); }

std::string renderer_of_this_machine() { return "none: this build has no simulator"; }

}  // namespace understory
