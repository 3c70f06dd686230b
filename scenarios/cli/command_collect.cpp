#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/cli/campaign_report.hpp"
#include "scenarios/cli/commands.hpp"

namespace understory {

void add_collect_command(CLI::App& app, Command& chosen) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("collect", "gather the results that a campaign's flights left");
  command->add_option("folder", *folder, "the campaign's results folder")->required();
  command->callback([folder, &chosen] {
    chosen = [folder] {
      const CampaignFolder results{*folder};
      return report(results, collect(results, read_campaign(results)));
    };
  });
}

}  // namespace understory
