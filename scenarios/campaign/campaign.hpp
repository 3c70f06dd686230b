#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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
  double timeout_s = 300;  ///< of wall time: a flight that takes longer hangs
};

/// One flight to be flown.
struct CampaignTask {
  std::string id;  ///< "<condition>-<seed>", unique
  std::size_t condition = 0;
  std::uint64_t seed = 0;
};

/// Finds the file that a scenario's name means, as on the command line.
using FindScenario = std::function<std::filesystem::path(const std::string&)>;

/// Reads a campaign file:
///
///     scenarios: [forest, dense]        # or scenario: forest; names of the library, or files beside this
///     one seeds: 1..200                     # or a list: [1, 7, 1000..1019] overrides: # optional, each
///     flown on its own
///       - {name: ours}
///       - {name: blind, set: {perception.detector: none}}
///     grid:                             # optional: every combination, over each override
///       autopilot.flight_model.cruise_speed_mps: [10, 12]
///     timeout_s: 300                    # optional, 1 .. 86400
///     name: speed                       # optional; otherwise the file's
///
/// Throws ScenarioError in one line, "file:line: key: expected ...": an unknown key, no seeds, a seed or a
/// condition twice, whatever a scenario refuses.
Campaign load_campaign(const std::filesystem::path& file, const FindScenario& find_scenario);

/// "1..200", "7" or a list of such things, as seeds. Throws ScenarioError, beginning with `where`.
std::vector<std::uint64_t> seeds_of(const std::vector<std::string>& ranges, const std::string& where);

/// All flights, condition by condition: the order of the rows.
std::vector<CampaignTask> tasks_of(const Campaign& campaign);

}  // namespace understory
