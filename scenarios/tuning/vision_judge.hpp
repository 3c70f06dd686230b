#pragma once

#include <filesystem>
#include <string_view>

#include "scenarios/evaluation/vision_score.hpp"
#include "scenarios/tuning/judge.hpp"

namespace understory {

/// As VisionScore has them, shares at one pixel: docs/tuning.md says what each is.
inline const std::vector<std::string> vision_figure_names{"precision", "recall",    "f_score",
                                                          "trunks_1m", "trunks_3m", "hits_per_frame"};

/// Whether the detector's hits on recordings can depend on a key of the scenario.
bool matters_on_recordings(std::string_view key);

/// Runs a scenario's pushbroom detector over recordings. Counts of a recording: RecordingScore's. A scenario
/// whose depths the rig cannot look at is refused.
class VisionJudge : public Judge {
 public:
  /// Holds every `every`-th frame of the recordings in memory and looks at `threads` recordings at a time;
  /// what comes out does not depend on it. Throws ScenarioError as VisionData does.
  VisionJudge(const std::vector<std::filesystem::path>& folders, int every, int threads);
  Measured measure(const std::string& name, const Scenario& scenario) override;
  Figures figures(std::span<const Counts> units) const override;

 private:
  std::vector<VisionData> recordings_;  ///< one folder each
  int threads_;
};

}  // namespace understory
