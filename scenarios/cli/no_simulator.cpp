#include <CLI/CLI.hpp>

#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"

/// The commands of a build without the simulator (UNDERSTORY_SIM=OFF).
namespace understory {
namespace {

void add_refusal(CLI::App& app, Command& chosen, const std::string& name) {
  CLI::App* command = app.add_subcommand(name, "not in this build: it has no simulator");
  command->allow_extras();
  command->callback([name, &chosen] {
    chosen = [name]() -> int {
      throw ScenarioError(name +
                          ": expected a build with the simulator, this one has none (UNDERSTORY_SIM=OFF)");
    };
  });
}

}  // namespace

int run_closed_loop_bench(const ClosedLoopBenchArguments&) {
  throw ScenarioError(
      "bench --closed-loop: expected a build with the simulator, this one has none (UNDERSTORY_SIM=OFF)");
}

std::vector<std::filesystem::path> record_suite(const std::filesystem::path& file,
                                                const std::filesystem::path&, int) {
  throw ScenarioError(file.string() +
                      ": expected a folder: this build has no simulator to record with (UNDERSTORY_SIM=OFF)");
}

void add_fly_command(CLI::App& app, Command& chosen) { add_refusal(app, chosen, "fly"); }
void add_record_command(CLI::App& app, Command& chosen) { add_refusal(app, chosen, "record"); }
void add_campaign_command(CLI::App& app, Command& chosen) { add_refusal(app, chosen, "campaign"); }
void add_tune_command(CLI::App& app, Command& chosen) { add_refusal(app, chosen, "tune"); }
void add_shard_command(CLI::App& app, Command& chosen) { add_refusal(app, chosen, "shard"); }
void add_validate_command(CLI::App& app, Command& chosen) { add_refusal(app, chosen, "validate"); }

}  // namespace understory
