#include "scenarios/cli/campaign_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/cli/commands.hpp"

namespace understory {

int report(const CampaignFolder& folder, const Collected& collected) {
  const auto not_flown =
      std::ranges::count_if(collected.rows, [](const FlightRow& row) { return !row.flown(); });
  const auto goals = std::ranges::count_if(collected.rows, &FlightRow::reached_goal);
  fmt::print("{} flights, {} at the goal; {} not flown, {} missing: {}\n", collected.rows.size(), goals,
             not_flown, collected.missing, folder.path.string());
  return not_flown == 0 && collected.missing == 0 ? exit_goal : exit_not_goal;
}

}  // namespace understory
