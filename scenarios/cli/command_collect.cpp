#include <fmt/format.h>

#include <memory>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/folder_mark.hpp"

namespace understory {
int report(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
           const std::filesystem::path& junit) {
  const Table table = summary_table(summarise(collected.rows));
  write_whole_file(folder.path / "summary.md", to_markdown(table));
  const std::string plots = campaign_svg(collected.rows, campaign.conditions);
  if (!plots.empty()) write_whole_file(folder.path / "campaign.svg", plots);
  if (!junit.empty()) write_whole_file(junit, campaign_junit(collected.rows));

  fmt::print("{}", to_text(table));
  std::size_t not_flown = 0;
  for (const FlightRow& row : collected.rows) {
    if (row.flown()) continue;
    if (++not_flown <= 10) fmt::print("not flown: {}: {}\n", row.id, row.reason);
  }
  if (not_flown > 10) fmt::print("not flown: {} more, see flights.csv\n", not_flown - 10);
  if (collected.missing > 0) fmt::print("missing: {} flights\n", collected.missing);
  fmt::print("rows and plots: {}\n", folder.path.string());
  return not_flown == 0 && collected.missing == 0 ? exit_goal : exit_not_goal;
}

void add_collect_command(CommandLine& line) {
  const auto folder = std::make_shared<std::string>();
  Command& command = line.add({"collect", "gather the results of a campaign's flights into tables",
                               "understory collect results/gate", "every flight was flown",
                               "a flight is missing or could not be flown"});
  command.text("folder", "FOLDER", *folder, "results folder of the campaign").required();
  command.runs([folder] {
    const CampaignFolder results{*folder};
    const Campaign campaign = read_campaign(results);
    FolderMark mark(results.path, campaign_results, results.path, FolderMark::Manner::beside_others);
    mark.add_names();
    return report(results, campaign, collect(results, campaign));
  });
}

}  // namespace understory
