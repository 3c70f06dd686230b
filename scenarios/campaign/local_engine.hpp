#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"

namespace understory {

struct LocalEngineConfig {
  int jobs = 1;             ///< flights at a time, each a process of its own
  bool keeps_runs = false;  ///< leaves each flight's run folder in runs/ID
};

/// How far it is.
struct CampaignProgress {
  std::size_t flights = 0;  ///< asked for
  std::size_t over = 0;     ///< of those, whatever became of them; and of those:
  std::size_t goals = 0, not_flown = 0;
  std::size_t before = 0;  ///< over before this run began
};
void count(const FlightRow& row, CampaignProgress& progress);
using OnCampaignProgress = std::function<void(const CampaignProgress&)>;

/// Clears away what flights left that were killed while they wrote. The folder must be locked.
void remove_parts(const CampaignFolder& folder);

/// Arguments of this program that fly one task and leave its file, from any folder, on any machine that sees
/// this one's files.
std::vector<std::string> flight_arguments(const CampaignFolder& folder, const Campaign& campaign,
                                          const CampaignTask& task, bool keeps_run);

/// Flies the tasks that are not flown yet, a process each, so that a crash, a hang or a kill costs one flight
/// and is written down as such. A flight dies with this program. False where SIGINT, SIGTERM or SIGHUP
/// stopped it; flights in the air then leave nothing. Throws MachineError where processes or files fail.
bool fly_locally(const CampaignFolder& folder, const Campaign& campaign,
                 const std::vector<CampaignTask>& tasks, const LocalEngineConfig& config,
                 const OnCampaignProgress& on_progress);

}  // namespace understory
