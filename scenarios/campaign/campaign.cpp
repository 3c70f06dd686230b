#include "scenarios/campaign/campaign.hpp"

#include <fmt/format.h>

namespace understory {

std::vector<CampaignTask> tasks_of(const Campaign& campaign) {
  std::vector<CampaignTask> tasks;
  for (std::size_t condition = 0; condition < campaign.conditions.size(); ++condition)
    for (const std::uint64_t seed : campaign.seeds)
      tasks.push_back({fmt::format("{}-{}", campaign.conditions[condition].name, seed), condition, seed});
  return tasks;
}

std::vector<CampaignTask> in_flying_order(const Campaign& campaign) {
  const std::vector<CampaignTask> tasks = tasks_of(campaign);
  const std::size_t seeds = campaign.seeds.size();
  std::vector<CampaignTask> order;
  for (std::size_t seed = 0; seed < seeds; ++seed)
    for (std::size_t condition = 0; condition < campaign.conditions.size(); ++condition)
      order.push_back(tasks[condition * seeds + seed]);
  return order;
}

}  // namespace understory
