#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace understory {

/// One way to fly: a scenario with its overrides.
struct Condition {
  std::string name;  ///< "forest-blind", "forest-cruise_speed_mps=10": letters, digits and . _ = -
  std::string
      scenario_text;  ///< the effective scenario, every value written; a flight's seed replaces its own
};

/// Many flights: every seed in every condition.
struct Campaign {
  std::string name;
  std::vector<Condition> conditions;
  std::vector<std::uint64_t> seeds;
  std::string renderer = "osmesa";  ///< renderer_kind.hpp's word: the machine's, given with the command
  double timeout_s = 300;           ///< of wall time: a flight that takes longer hangs
};

/// One flight to be flown.
struct CampaignTask {
  std::string id;  ///< "<condition>-<seed>", unique
  std::size_t condition = 0;
  std::uint64_t seed = 0;
};

/// All flights, condition by condition: the order of the rows.
std::vector<CampaignTask> tasks_of(const Campaign& campaign);
/// The same seed by seed, as they are flown: an unfinished campaign compares the same forests.
std::vector<CampaignTask> in_flying_order(const Campaign& campaign);

}  // namespace understory
