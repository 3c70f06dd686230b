#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/local_engine.hpp"

namespace understory {

/// How a campaign becomes a job array: every shard a task of it, a share of the flights one after the other.
/// The folder and this program must be where every node sees them, under the same names.
struct SlurmConfig {
  int shards = 8;                    ///< 1 .. 10000
  std::vector<std::string> options;  ///< of sbatch: "--partition=short"
};

/// The flights of one shard, numbers from 0: every `shards`-th in flying order. Each is in exactly one.
std::vector<CampaignTask> tasks_of_shard(const Campaign& campaign, int number, int shards);

/// The script that sbatch is given. Requeued where a node dies, a shard goes on with what is not flown yet.
std::string slurm_script(const CampaignFolder& folder, const Campaign& campaign, const SlurmConfig& config);

/// Writes the script into the folder and submits it; gives the job's number. Throws MachineError with
/// sbatch's own words where there is no Slurm or it refuses.
std::string submit_to_slurm(const CampaignFolder& folder, const Campaign& campaign,
                            const SlurmConfig& config);

/// Waits until every flight is flown or the job is gone, which is told by squeue. False where a signal
/// stopped the waiting: the job goes on without us.
bool wait_for_slurm(const CampaignFolder& folder, const Campaign& campaign, const std::string& job,
                    const OnCampaignProgress& on_progress);

}  // namespace understory
