#include <fmt/format.h>

#include <algorithm>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/engines.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/tuning/judge.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

Counts counts_of(const FlightRow& row) {
  return {row.reached_goal() ? 1.0 : 0.0,
          row.reached_goal() ? 1.0 : std::clamp(row.progress_m / row.goal_m, 0.0, 1.0), row.mean_speed_mps,
          row.position_error_mean_m};
}

/// Flights of another scenario that went by this name are of no use any more.
void keep_condition(const CampaignFolder& folder, const Campaign& campaign) {
  const Condition& condition = campaign.conditions.front();
  const fs::path file = folder.condition_file(condition);
  if (text_if_there(file) == condition.scenario_text) return;
  for (const CampaignTask& task : tasks_of(campaign)) fs::remove(folder.flight_file(task));
  write_lasting_file(file, condition.scenario_text);
}

class FlightJudge : public Judge {
 public:
  explicit FlightJudge(FlightJudgeConfig config) : config_(std::move(config)), folder_{config_.folder} {
    for (const char* part : {"conditions", "flights", "logs"}) prepare_output_folder(folder_.path / part);
  }

  Measured measure(const std::string& name, const Scenario& scenario) override {
    const Campaign campaign{
        "tuning", {{name, scenario_to_text(scenario)}}, config_.seeds, config_.renderer, config_.timeout_s};
    keep_condition(folder_, campaign);
    const std::vector<CampaignTask> tasks = tasks_of(campaign);
    if (!fly_locally(folder_, campaign, tasks, {config_.jobs, false}, {})) throw Stopped{};
    Measured measured;
    for (const CampaignTask& task : tasks) {
      const FlightRow row = read_flight(folder_, task).value_or(FlightFile{}).row;
      if (row.status == RunStatus::killed)  // not the scenario's fault: flown again when the tuning goes on
        throw MachineError(fmt::format("{}-{}: {}; --resume goes on", name, task.seed, row.reason));
      if (!row.flown()) return {{}, fmt::format("seed {}: {}", task.seed, row.reason)};
      measured.units.push_back(counts_of(row));
    }
    return measured;
  }

  Figures figures(std::span<const Counts> units) const override {
    Figures means(flight_figure_names.size(), 0);
    for (const Counts& flight : units)
      for (std::size_t i = 0; i < means.size(); ++i) means[i] += flight[i];
    for (double& mean : means) mean /= static_cast<double>(units.size());  // all at the goal: exactly 1
    return means;
  }

 private:
  FlightJudgeConfig config_;
  CampaignFolder folder_;
};

}  // namespace

const std::vector<std::string> flight_figure_names{"success", "progress", "mean_speed_mps",
                                                   "position_error_m"};

std::unique_ptr<Judge> flight_judge(FlightJudgeConfig config) {
  return std::make_unique<FlightJudge>(std::move(config));
}

}  // namespace understory
