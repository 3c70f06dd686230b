#include "scenarios/cli/campaign_report.hpp"

#include <fmt/format.h>

#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {

int report(const CampaignFolder& folder, const Collected& collected, const std::filesystem::path& junit) {
  const Table table = summary_table(summarise(collected.rows));
  write_whole_file(folder.path / "summary.md", to_markdown(table));
  const std::string plots = campaign_svg(collected.rows);
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

}  // namespace understory
