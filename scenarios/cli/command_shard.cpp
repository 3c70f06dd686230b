#include <fmt/format.h>

#include <memory>

#include "scenarios/campaign/engines.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/signals.hpp"

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
  const StopSignals stop_signals;
  LocalEngineConfig config;
  config.jobs = arguments.jobs;
  const bool finished =
      fly_locally(folder, campaign, tasks_of_shard(campaign, arguments.number, arguments.of), config, {});
  if (!finished) throw Stopped(stop_signals.number(), "stopped; the same command goes on");
  return exit_goal;
}

}  // namespace

void add_shard_command(CommandLine& line) {
  const auto arguments = std::make_shared<ShardArguments>();
  Command& command =
      line.add({"shard", "fly a share of a campaign: what campaign --engine slurm submits",
                "understory shard results/gate --number 0 --of 8", "the share's flights were flown"});
  command.text("folder", "FOLDER", arguments->folder, "the campaign's results folder").required();
  command.whole("--number", arguments->number, 0, 9999, "which share, from 0").required();
  command.whole("--of", arguments->of, 1, 10000, "how many shares there are").required();
  command.whole("--jobs", arguments->jobs, 1, 1024, "flights at a time");
  command.runs([arguments] { return run_shard(*arguments); });
}

}  // namespace understory
