#include "scenarios/campaign/engines.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <thread>

#include "scenarios/output/file_output.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds queue_checked_every{1};

struct Answer {
  int status = -1;
  std::string text;  ///< both streams, without the last newline
};

Answer ask(const std::string& command) {
  Answer answer;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return answer;
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) answer.text += buffer.data();
  const int status = pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  while (!answer.text.empty() && answer.text.back() == '\n') answer.text.pop_back();
  return answer;
}

CampaignProgress progress_of(const CampaignFolder& folder, const std::vector<CampaignTask>& tasks) {
  CampaignProgress progress;
  progress.flights = tasks.size();
  for (const CampaignTask& task : tasks)
    if (const auto file = read_flight(folder, task)) count(file->row, progress);
  return progress;
}

}  // namespace

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::vector<CampaignTask> tasks_of_shard(const Campaign& campaign, int number, int shards) {
  const std::vector<CampaignTask> all = in_flying_order(campaign);
  std::vector<CampaignTask> mine;
  for (std::size_t i = static_cast<std::size_t>(number); i < all.size();
       i += static_cast<std::size_t>(shards))
    mine.push_back(all[i]);
  return mine;
}

std::string slurm_script(const CampaignFolder& folder, const Campaign& campaign, const SlurmConfig& config) {
  const fs::path path = fs::absolute(folder.path).lexically_normal();
  std::string script = fmt::format(
      "#!/bin/sh\n"
      "#SBATCH --job-name=understory-{}\n"
      "#SBATCH --array=0-{}\n"
      "#SBATCH --requeue\n"
      "#SBATCH --output={}/logs/shard-%a.log\n"
      "#SBATCH --open-mode=append\n",
      campaign.name, config.shards - 1, path.string());
  for (const std::string& option : config.options) script += "#SBATCH " + option + "\n";
  return script + fmt::format("exec {} shard {} --number \"$SLURM_ARRAY_TASK_ID\" --of {}\n",
                              quoted(fs::read_symlink("/proc/self/exe").string()), quoted(path.string()),
                              config.shards);
}

std::string submit_to_slurm(const CampaignFolder& folder, const Campaign& campaign,
                            const SlurmConfig& config) {
  const fs::path file = folder.path / "slurm.sh";
  write_whole_file(file, slurm_script(folder, campaign, config));
  const Answer answer = ask("sbatch --parsable " + quoted(file.string()));
  const std::string last = answer.text.substr(answer.text.rfind('\n') + 1);  // warnings come before
  if (answer.status == 127) throw MachineError("--engine slurm: sbatch is missing: install Slurm's commands");
  if (answer.status != 0 || last.empty() || std::isdigit(static_cast<unsigned char>(last[0])) == 0)
    throw MachineError(fmt::format("sbatch {}: {}", file.string(), answer.text));
  return last.substr(0, last.find(';'));  // "job" or "job;cluster"
}

bool wait_for_slurm(const CampaignFolder& folder, const Campaign& campaign, const std::string& job,
                    const OnCampaignProgress& on_progress) {
  const StopSignals stop_signals;
  const std::vector<CampaignTask> tasks = tasks_of(campaign);
  const std::size_t before = progress_of(folder, tasks).over;
  while (!stop_signals.asked()) {
    // Asked first: what the job's last moments left is then counted.
    const Answer queue = ask("squeue --noheader --jobs=" + job + " --format=%T");
    CampaignProgress progress = progress_of(folder, tasks);
    progress.before = before;
    if (on_progress && progress.over > before) on_progress(progress);
    const bool gone =
        queue.status == 0 ? queue.text.empty() : queue.text.find("Invalid job id") != std::string::npos;
    if (gone) return true;
    std::this_thread::sleep_for(queue_checked_every);
  }
  return false;
}

}  // namespace understory
