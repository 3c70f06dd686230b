#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/local_engine.hpp"
#include "scenarios/tuning/judge.hpp"

namespace understory {

/// success: share of flights at the goal; progress: how far they came, of the way to the goal, mean.
inline const std::vector<std::string> flight_figure_names{"success", "progress", "mean_speed_mps",
                                                          "position_error_m"};

struct FlightJudgeConfig {
  std::filesystem::path folder;      ///< keeps each flight's file: what is flown is not flown again
  std::vector<std::uint64_t> seeds;  ///< one or more
  std::string renderer = "osmesa";
  double timeout_s = 300;  ///< of wall time: a flight that takes longer hangs
  int jobs = 1;            ///< flights at a time, each a process
};

/// Flies a scenario with every seed. Counts of a flight: at the goal (0 or 1), then the other figures. A
/// scenario of which a flight failed to run is refused; a flight that somebody killed is the machine's
/// failure.
class FlightJudge : public Judge {
 public:
  explicit FlightJudge(FlightJudgeConfig config);
  Measured measure(const std::string& name, const Scenario& scenario) override;
  Figures figures(std::span<const Counts> units) const override;

 private:
  FlightJudgeConfig config_;
  CampaignFolder folder_;
};

}  // namespace understory
