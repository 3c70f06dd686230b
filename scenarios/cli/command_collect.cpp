#include <fmt/format.h>

#include <memory>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/cli/campaign_report.hpp"
#include "scenarios/cli/commands.hpp"

namespace understory {

void add_collect_command(CommandLine& line) {
  const auto folder = std::make_shared<std::string>();
  Command& command = line.add({"collect", "gather the results that a campaign's flights left",
                               "understory collect results/gate", "every flight was flown",
                               "a flight is missing or could not be flown"});
  command.text("folder", "FOLDER", *folder, "the campaign's results folder").required();
  command.runs([folder] {
    const CampaignFolder results{*folder};
    return report(results, collect(results, read_campaign(results)));
  });
}

}  // namespace understory
