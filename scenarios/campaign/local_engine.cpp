#include "scenarios/campaign/engines.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <thread>

#include "scenarios/output/file_output.hpp"
#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds checked_every{10};  ///< a flight takes seconds
/// exit_bad_input and exit_machine_failed of the command line.
constexpr int status_refused = 2, status_machine_failed = 3;

struct InTheAir {
  const CampaignTask* task = nullptr;
  int looks = 0;  ///< at it. A batch system that suspends us suspends our flights, too: nobody looks then.
  bool hung = false;
};

/// What a flight without a file of its own is written down as.
FlightRow row_of_failure(int wait_status, bool hung, double timeout_s, const std::string& last_words) {
  FlightRow row;
  const std::string words = last_words.empty() ? "" : ": " + last_words;
  if (hung) {
    row.status = RunStatus::hung;
    row.reason = fmt::format("took longer than timeout_s = {:g} s", timeout_s);
  } else if (WIFSIGNALED(wait_status)) {
    const int signal = WTERMSIG(wait_status);
    const bool from_outside = signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
    row.status = from_outside ? RunStatus::killed : RunStatus::crashed;
    row.reason = fmt::format("signal {} ({}){}", signal, strsignal(signal), words);
  } else if (WEXITSTATUS(wait_status) == status_refused) {
    row.status = RunStatus::refused;
    row.reason = last_words;
  } else {
    row.status = RunStatus::crashed;
    row.reason = WEXITSTATUS(wait_status) == status_machine_failed
                     ? last_words
                     : fmt::format("status {}, no result{}", WEXITSTATUS(wait_status), words);
  }
  return row;
}

/// Leaves the process to be waited for.
bool is_over(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
}

/// The flights in the air, and what becomes of them.
class Flights {
 public:
  Flights(const CampaignFolder& folder, const Campaign& campaign, const LocalEngineConfig& config,
          const StopSignals& stop_signals)
      : folder_(folder), campaign_(campaign), config_(config), stop_signals_(stop_signals) {}
  ~Flights() {
    try {
      stop();
    } catch (const std::exception&) {  // of what the flights left: the next run sees to it
    }
  }
  Flights(const Flights&) = delete;
  Flights& operator=(const Flights&) = delete;

  bool full() const { return air_.size() >= static_cast<std::size_t>(config_.jobs); }
  bool empty() const { return air_.empty(); }

  void launch(const CampaignTask& task) {
    fs::remove(folder_.flight_file(task));  // how it failed the last time is no answer any more
    const pid_t child = start_this_program(flight_arguments(folder_, campaign_, task, config_.keeps_runs),
                                           SIGKILL, folder_.log_file(task));
    air_[child] = {&task};
  }

  /// Each flight that is over, with what it left.
  template <typename OnOver>
  void land(OnOver&& on_over) {
    for (auto flight = air_.begin(); flight != air_.end();) {
      const EndedProcess process = wait_for_process(flight->first, WNOHANG);
      const double taken_s = ++flight->second.looks * std::chrono::duration<double>(checked_every).count();
      if (process.pid == 0) {
        if (!flight->second.hung && taken_s > campaign_.timeout_s) {
          flight->second.hung = true;
          kill(flight->first, SIGKILL);
        }
        ++flight;
        continue;
      }
      const CampaignTask& task = *flight->second.task;
      const bool hung = flight->second.hung;
      flight = air_.erase(flight);
      auto file = read_flight(folder_, task);
      if (!file) {
        if (everything_stops(process.wait_status, hung)) return;
        file = FlightFile{row_of_failure(process.wait_status, hung, campaign_.timeout_s,
                                         last_line_of(folder_.log_file(task))),
                          {taken_s, process.peak_memory_mb}};
        write_flight(folder_, campaign_, task, *file);
      } else {
        fs::remove(folder_.log_file(task));
      }
      on_over(file->row);
    }
  }

  /// A batch system stops all processes of a job, and a flight may go before we do: it was not that flight's
  /// fate to be killed, and it is left for the next time.
  bool everything_stops(int wait_status, bool hung) const {
    if (hung || !WIFSIGNALED(wait_status)) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return stop_signals_.asked();
  }

  /// A flight clears away what it has not finished, if it is asked to end; one that does not listen is
  /// killed.
  void stop() {
    for (const auto& [child, flight] : air_) kill(child, SIGTERM);
    for (int attempt = 0;
         attempt < 50 && !std::ranges::all_of(air_, [](const auto& one) { return is_over(one.first); });
         ++attempt)
      std::this_thread::sleep_for(checked_every);
    for (const auto& [child, flight] : air_) kill(child, SIGKILL);
    for (const auto& [child, flight] : air_) {
      waitpid(child, nullptr, 0);
      std::error_code ignored;
      if (!read_flight(folder_, *flight.task)) fs::remove(folder_.log_file(*flight.task), ignored);
    }
    air_.clear();
    remove_parts(folder_);
  }

 private:
  const CampaignFolder& folder_;
  const Campaign& campaign_;
  const LocalEngineConfig& config_;
  const StopSignals& stop_signals_;
  std::map<pid_t, InTheAir> air_;
};

}  // namespace

void remove_parts(const CampaignFolder& folder) {
  for (const char* part : {"conditions", "flights", "tracks", "logs", "runs"})
    clear_unfinished(folder.path / part);
}

void count(const FlightRow& row, CampaignProgress& progress) {
  progress.over += 1;
  progress.goals += row.reached_goal() ? 1 : 0;
  progress.not_flown += row.flown() ? 0 : 1;
}

std::vector<std::string> flight_arguments(const CampaignFolder& folder, const Campaign& campaign,
                                          const CampaignTask& task, bool keeps_run) {
  const CampaignFolder whole{fs::absolute(folder.path).lexically_normal()};
  const std::string condition = whole.condition_file(campaign.conditions[task.condition]).string();
  std::vector<std::string> arguments{"fly", condition, "--seed", fmt::format("{}", task.seed), "--quiet"};
  arguments.insert(arguments.end(), {"--row", whole.flight_file(task).string()});
  const fs::path track = whole.track_file(task.id);
  if (fs::exists(track.parent_path()))
    arguments.insert(arguments.end(), {"--track", track.string()});  // not in a tuning
  arguments.insert(arguments.end(), {"--renderer", campaign.renderer});
  if (campaign.recording.form)
    arguments.insert(arguments.end(), {"--record", std::string(word_for(*campaign.recording.form)), "--every",
                                       fmt::format("{}", campaign.recording.every)});
  if (keeps_run || campaign.recording.form)
    arguments.insert(arguments.end(), {"--out", (whole.path / "runs" / task.id).string()});
  return arguments;
}

bool fly_locally(const CampaignFolder& folder, const Campaign& campaign,
                 const std::vector<CampaignTask>& tasks, const LocalEngineConfig& config,
                 const OnCampaignProgress& on_progress) {
  const StopSignals stop_signals;
  CampaignProgress progress;
  progress.flights = tasks.size();
  std::vector<const CampaignTask*> left;
  for (const CampaignTask& task : tasks) {
    if (stop_signals.asked()) return false;
    const auto file = read_flight(folder, task);
    if (file && file->row.flown()) {
      std::error_code ignored;
      fs::remove(folder.log_file(task), ignored);  // a kill came between row and log
      count(file->row, progress);
    } else {
      left.push_back(&task);
    }
  }
  progress.before = progress.over;
  Flights flights(folder, campaign, config, stop_signals);
  std::size_t next = 0;
  while (next < left.size() || !flights.empty()) {
    if (stop_signals.asked()) return false;
    while (next < left.size() && !flights.full()) flights.launch(*left[next++]);
    std::this_thread::sleep_for(checked_every);
    flights.land([&](const FlightRow& row) {
      count(row, progress);
      if (on_progress) on_progress(progress);
    });
  }
  return true;
}

}  // namespace understory
