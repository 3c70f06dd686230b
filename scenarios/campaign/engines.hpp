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

/// How far a campaign is.
struct CampaignProgress {
  std::size_t flights = 0;  ///< requested
  std::size_t over = 0;     ///< of those, however they ended; and of those:
  std::size_t goals = 0, not_flown = 0;
  std::size_t before = 0;  ///< over before this run began
};
void count(const FlightRow& row, CampaignProgress& progress);
using OnCampaignProgress = std::function<void(const CampaignProgress&)>;

/// Removes unfinished files of flights that were killed while they wrote. The folder must be locked.
void remove_parts(const CampaignFolder& folder);

/// Arguments of this program that fly one task and leave its file, from any folder, on any machine that sees
/// this one's files.
std::vector<std::string> flight_arguments(const CampaignFolder& folder, const Campaign& campaign,
                                          const CampaignTask& task, bool keeps_run);

/// Flies the tasks that are not flown yet, a process each, so that a crash, a hang or a kill costs one flight
/// and is written down as such. Flights end with this program. False if SIGINT, SIGTERM or SIGHUP stopped it;
/// flights in the air then leave nothing. Throws MachineError if processes or files fail.
bool fly_locally(const CampaignFolder& folder, const Campaign& campaign,
                 const std::vector<CampaignTask>& tasks, const LocalEngineConfig& config,
                 const OnCampaignProgress& on_progress);

/// For a shell: nothing within is special.
std::string quoted(const std::string& word);

/// How a campaign becomes a job array: each task is a shard, which flies a share of the flights one after the
/// other. The folder and this program must be where every node sees them, under the same names.
struct SlurmConfig {
  int shards = 8;                    ///< 1 .. 10000
  std::vector<std::string> options;  ///< of sbatch: "--partition=short"
};

/// The flights of one shard, numbers from 0: every `shards`-th in flying order. Each is in exactly one.
std::vector<CampaignTask> tasks_of_shard(const Campaign& campaign, int number, int shards);

/// The script for sbatch. A shard that is requeued after its node died flies the flights that remain.
std::string slurm_script(const CampaignFolder& folder, const Campaign& campaign, const SlurmConfig& config);

/// Writes the script into the folder and submits it; gives the job's number. Throws MachineError with
/// sbatch's own words where there is no Slurm or it refuses.
std::string submit_to_slurm(const CampaignFolder& folder, const Campaign& campaign,
                            const SlurmConfig& config);

/// Waits until every flight is flown or the job is gone, according to squeue. False if a signal stopped the
/// waiting: the job continues without us.
bool wait_for_slurm(const CampaignFolder& folder, const Campaign& campaign, const std::string& job,
                    const OnCampaignProgress& on_progress);

}  // namespace understory
