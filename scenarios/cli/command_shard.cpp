#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <thread>

#include "scenarios/campaign/local_engine.hpp"
#include "scenarios/campaign/slurm_engine.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

struct ShardArguments {
  std::string folder;
  int number = 0;
  int of = 1;
  int jobs = 1;
};

int run_shard(const ShardArguments& arguments) {
  const CampaignFolder folder{arguments.folder};
  const Campaign campaign = read_campaign(folder);
  if (arguments.number >= arguments.of)
    throw ScenarioError(
        fmt::format("--number {}: expected less than --of {}", arguments.number, arguments.of));
  LocalEngineConfig config;
  config.jobs = arguments.jobs;
  const bool finished =
      fly_locally(folder, campaign, tasks_of_shard(campaign, arguments.number, arguments.of), config, {});
  if (!finished) throw MachineError("stopped; the same command goes on");
  return exit_goal;
}

}  // namespace

void add_shard_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<ShardArguments>();
  CLI::App* command =
      app.add_subcommand("shard", "fly a share of a campaign: what campaign --engine slurm submits");
  command->add_option("folder", arguments->folder, "the campaign's results folder")->required();
  command->add_option("--number", arguments->number, "which share, from 0")
      ->required()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--of", arguments->of, "how many shares there are")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--jobs", arguments->jobs, "flights at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_shard(*arguments); }; });
}

}  // namespace understory
